"""Print what it costs that each stage has a process of its own.

Run with `python tests/bench/bench_isolation.py [CITY]`, an indexed city folder; without
one the photographs of a painted block are built. Each round builds twice from nothing,
in turn with and without processes of their own, and the ratio of the CPU seconds of all
processes is printed, and of the wall's.
"""

import argparse
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from pipelines import index
from pipelines.demo import painted

BASELINE = 0.0  # seconds that a stage may take: none, it has no process of its own
ISOLATED = 300.0
ROUNDS = 3


def main() -> None:
    """Build and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("city", nargs="?", type=Path)
    parser.add_argument("--workers", type=int, default=1)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        city = asked.city or example(Path(folder))
        ratios = []
        for turn in range(ROUNDS):
            order = (BASELINE, ISOLATED) if turn % 2 else (ISOLATED, BASELINE)
            took = {one: built(city, Path(folder), one, asked.workers) for one in order}
            (cpu, wall), (cpu_before, wall_before) = took[ISOLATED], took[BASELINE]
            ratios.append(cpu / cpu_before)
            print(
                f"isolated {cpu:.1f} CPU s, {wall:.1f} s; baseline {cpu_before:.1f} "
                f"CPU s, {wall_before:.1f} s; CPU {ratios[-1]:.3f} of the baseline"
            )
        print(f"median: {statistics.median(ratios):.3f} of the CPU seconds without")


def example(folder: Path) -> Path:
    """Paint a block, and index it."""
    photos, listed = painted(folder, blocks=1, tell=lambda *_: None)
    index.index(photos, listed, str(folder / "example"))
    return folder / "example"


def built(
    city: Path, folder: Path, seconds: float, workers: int
) -> tuple[float, float]:
    """Build a fresh copy of a city; give its CPU seconds and the clock's."""
    fresh = folder / "fresh"
    fresh.mkdir()
    for name in ("manifest.csv", "manifest.parquet"):
        shutil.copy(city / name, fresh / name)
    flags = [f"--stage-seconds={seconds}", f"--direct_num_workers={workers}"]
    words = [sys.executable, "-m", "pipelines.cli", "build", str(fresh), *flags]
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(words, check=True, capture_output=True)
    wall, after = (
        time.perf_counter() - began,
        resource.getrusage(resource.RUSAGE_CHILDREN),
    )
    shutil.rmtree(fresh)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return cpu, wall


if __name__ == "__main__":
    main()
