"""What publishing holds in memory, by the size of the city.

    python tests/bench/bench_publish.py [BLOCKS ..., default 1000 10000]

A run's tables are written for so many blocks of 24 lots, a photograph each; nobody made
their models, which are a few bytes, and there are no small pictures. Each city is
published in a process of its own. *held* is what its most memory is above that of a
process that has loaded the same modules and published nothing; *site.json* what a
browser reads first, *records* the bytes of all records. Baseline: the fewest blocks.
"""

import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Final

from pipelines import site
from pipelines.models import Models
from pipelines.store import Store
from pipelines.store.versions import Versions
from tests.pipelines.site import tables

COUNTS: Final = (1000, 10_000)
LOTS: Final = 24
MIB: Final = 2**20


def published(folder: str) -> None:
    """Publish what lies in a folder, if anything; print CPU seconds and MiB."""
    store = Store(folder, era="one")
    versions = Versions.present(Models())
    began = time.process_time()
    if folder:
        site.publish(store, tables.RUN, versions)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(time.process_time() - began, peak)


def measured(folder: str) -> tuple[float, float]:
    """Publish in a process of its own."""
    own = [sys.executable, "-m", "tests.bench.bench_publish", "--publish", folder]
    told = subprocess.run(own, check=True, capture_output=True, text=True).stdout
    seconds, peak = map(float, told.split()[-2:])
    return seconds, peak


def size_of(folder: Path) -> float:
    """Measure a folder's files, in MiB."""
    return sum(one.stat().st_size for one in folder.iterdir()) / MIB


def main(counts: list[int]) -> None:
    """Print what each city's publishing takes."""
    _, empty = measured("")
    print(f"a process that publishes nothing: {empty:.0f} MiB")
    print("  blocks buildings  held MiB  KiB/block  CPU s  site.json MiB  records MiB")
    first = 0.0
    for count in counts:
        with tempfile.TemporaryDirectory() as folder:
            tables.write(Store(folder), count, LOTS)
            seconds, peak = measured(folder)
            held, where = peak - empty, Path(folder) / "site"
            each = 1024 * held / count
            first = first or each
            size = (where / "site.json").stat().st_size / MIB
            print(
                f"{count:8} {count * LOTS:9} {held:9.0f} {each:10.1f} {seconds:6.1f} "
                f"{size:14.1f} {size_of(where / 'records'):12.1f}   "
                f"{each / first:.2f} x the memory a block",
                flush=True,
            )


if __name__ == "__main__":
    if sys.argv[1:2] == ["--publish"]:
        published(sys.argv[2])
    else:
        main([int(one) for one in sys.argv[1:]] or list(COUNTS))
