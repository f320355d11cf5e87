"""What the metadata of a collection costs, planned and grouped, no picture read.

    python tests/bench/bench_growth.py [ROWS, default 10000]

A manifest of so many rows is asked for (`ask`), and the pipeline's plan groups its
photos and blocks on the embedded runner, in a process of its own. Baseline: a third of
the rows; a row is to cost the same, and memory to grow by less than the rows.
"""

import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import replace

import apache_beam as beam

from nostalgin_core.records import Front
from pipelines.build.planned import Plan
from pipelines.index import manifest, source
from pipelines.index.asked import ask
from pipelines.store import Store

LOTS = 36  # of a block
FRONT = Front("1-1-0", "1", "1", 0, 0, 0, "Elm Street", "1", 8.0, None, False)  # noqa: FBT003
KIB = 1024


def listed(store: Store, rows: int) -> None:
    """Write a manifest of a photo a front."""
    cells = []
    for number in range(rows):
        block, rank = divmod(number, LOTS)
        own = {"front_id": f"{block}-{rank}", "block": str(block), "lot": str(rank)}
        front = replace(FRONT, rank=rank, **own)
        cells.append(manifest.row_of(f"{number}.jpg", front, root="photos", credit=""))
    manifest.write(store, cells)


def planned(folder: str) -> None:
    """Ask and plan, and print the CPU seconds of both and the most memory."""
    store = Store(folder)
    before = time.process_time()
    todo = ask(store, source.found(store), "run")
    asked_s = time.process_time() - before
    with beam.Pipeline(runner="FnApiRunner") as pipeline:
        made = pipeline | Plan(store, todo)
        _ = made.blocks | beam.combiners.Count.Globally()
        _ = made.photos | "Photos counted" >> beam.combiners.Count.Globally()
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * KIB / 1e9
    print(asked_s, time.process_time() - before - asked_s, peak)


def measured(rows: int) -> tuple[float, float, float]:
    """Plan so many rows in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        listed(Store(folder), rows)
        said = subprocess.check_output([sys.executable, __file__, "--in", folder])
    asked_s, planned_s, gigabytes = map(float, said.split()[-3:])
    return asked_s, planned_s, gigabytes


def main(rows: int) -> None:
    """Print what both sizes cost, and their ratio for a row."""
    small, large = measured(rows // 3), measured(rows)
    for count, (asked_s, planned_s, most) in ((rows // 3, small), (rows, large)):
        print(
            f"{count:8} rows: asked {asked_s:6.1f} CPU s, planned and grouped "
            f"{planned_s:6.1f} CPU s, peak {most:.2f} GB"
        )
    ratio = sum(large[:2]) / sum(small[:2]) * (rows // 3) / rows
    print(f"a row at {rows} costs {ratio:.2f} of one at {rows // 3}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--in"]:
        planned(sys.argv[2])
    else:
        main(int(sys.argv[1]) if sys.argv[1:] else 10_000)
