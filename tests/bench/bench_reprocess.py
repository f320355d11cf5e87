"""What it costs to redo one photograph of many, beside a fresh build of all.

    python tests/bench/bench_reprocess.py [PHOTOS, default 36]

Tiny painted photographs and small networks, so that what is told is the cost of finding
and publishing, not of the stages; CPU seconds count. Baseline: a fresh build.
"""

import sys
import tempfile
from pathlib import Path

from tests.bench import tiny


def main(photos: int) -> None:
    """Build, find nothing stale, change one photograph, and redo it."""
    with tempfile.TemporaryDirectory() as folder:
        city = tiny.archive(Path(folder), photos)
        fresh = tiny.built(city)
        tiny.built(city, what="reprocess")  # of what is as young as the run: hashed
        idle = tiny.built(city, what="reprocess")
        path = next((city.parent / "photos").iterdir())
        path.write_bytes(path.with_name("1_1.png").read_bytes() + b"another")
        redone = tiny.built(city, what="reprocess")
        spent = tiny.record(city)
    print(f"{photos} photographs, build from nothing  {fresh.cpu_s:8.1f} CPU s")
    for what, one in (("nothing is stale", idle), ("one has changed", redone)):
        ratio = one.cpu_s / fresh.cpu_s
        print(
            f"reprocess, {what:18} {one.cpu_s:8.1f} CPU s, {ratio:6.3f} of a build, "
            f"peak {one.peak_gb:.2f} GB"
        )
    estimated = spent.get("estimated", {}).get("cpu_seconds")
    print(f"estimated {estimated} CPU s of the stages, spent {spent['cpu_seconds']}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if sys.argv[1:] else 36)
