"""How costs grow with a collection, each part by itself.

    python tests/bench/bench_growth.py [metadata ROWS, default 10000]
    python tests/bench/bench_growth.py photos [PHOTOS, default 60]
    python tests/bench/bench_growth.py memory [PHOTOS, default 1000]
    python tests/bench/bench_growth.py processes [PHOTOS, default 48]
    python tests/bench/bench_growth.py overhead [PHOTOS, default 2]

*metadata*: a manifest of so many rows is asked for (`ask`), and the pipeline's plan
groups its photos and blocks on the embedded runner, in a process of its own; no picture
is read. Baseline: a third of the rows; a row is to cost the same.

*photos*: tiny painted photographs are built from nothing, so many and a tenth and a
hundredth of them. Baseline: the fewest; a photograph is to cost the same, and memory of
driver and workers to stay.

*memory*: the same of few contents, so that stages do little and as many references
pass: what driver and workers hold of 100 photographs, and of so many. From 1,024 rows
on two processes have more than one pass (`pipelines.build.passes`). Baseline: 100.

*processes*: the same city in one process and in two, on the clock, which a busy machine
spoils. Baseline: one process.

*overhead*: real tax photographs (NOSTALGIN_DATA) with the shipped networks. Baseline:
the plain loop over the same photographs; facades that no wall wears, which the loop
fills as well, are taken off by the mean of all.
"""

import resource
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest import mock

import apache_beam as beam

from nostalgin_core import inpaint, reconstruct, steps
from nostalgin_core.records import Elevation, Front
from pipelines.build.planned import Plan
from pipelines.index import manifest, source
from pipelines.index.asked import ask
from pipelines.index.row import Row
from pipelines.models import Models, one_thread
from pipelines.store import Store, runs
from tests.bench import tiny
from tests.data import DATA

LOTS = 36  # of a block
FRONT = Front("1-1-0", "1", "1", 0, 0, 0, "Elm Street", "1", 8.0, None, False)  # noqa: FBT003
KIB = 1024
NONE = "--shard=1/1000000"  # of the blocks: a run that starts, and has nothing to do


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


def metadata(rows: int) -> None:
    """Print what both sizes cost, and their ratio for a row."""
    small, large = measured(rows // 3), measured(rows)
    for count, (asked_s, planned_s, most) in ((rows // 3, small), (rows, large)):
        print(
            f"{count:8} rows: asked {asked_s:6.1f} CPU s, planned and grouped "
            f"{planned_s:6.1f} CPU s, peak {most:.2f} GB"
        )
    ratio = sum(large[:2]) / sum(small[:2]) * (rows // 3) / rows
    print(f"a row at {rows} costs {ratio:.2f} of one at {rows // 3}")


def photos(most: int) -> None:
    """Print what a photograph costs, and the memory that it takes."""
    first = 0.0
    for count in sorted({max(most // 100, 12), max(most // 10, 12), most}):
        with tempfile.TemporaryDirectory() as folder:
            city = tiny.archive(Path(folder), count)
            start = tiny.built(city, NONE, *of(2))
            cost = tiny.built(city, *of(2))
            told = tiny.record(city)
        each = 1000 * (cost.cpu_s - start.cpu_s) / count
        first = first or each
        memory = ", ".join(f"{who} {mb} MB" for who, mb in told["memory_mb"].items())
        stages = 1000 * told["cpu_seconds"] / count
        print(
            f"{count:6} photographs: {each:7.1f} CPU ms each ({stages:.1f} of the "
            f"stages), {each / first:.2f} of the first; {memory}; the largest process "
            f"{cost.peak_gb:.2f} GB",
            flush=True,
        )


def memory(most: int) -> None:
    """Print what memory a photograph takes beyond the first hundred."""
    first: dict[str, int] = {}
    for count in sorted({100, most}):
        with tempfile.TemporaryDirectory() as folder:
            city = tiny.archive(Path(folder), count, own=False)
            cost = tiny.built(city, *of(2))
            held = tiny.record(city)["memory_mb"]
        first = first or held
        more = ", ".join(
            f"{who} {mb} MB ({1000 * (mb - first[who]) / max(count - 100, 1):.0f} kB "
            "a photograph more)"
            for who, mb in held.items()
        )
        print(f"{count:6} photographs: {cost.cpu_s:7.1f} CPU s; {more}", flush=True)


def processes(count: int) -> None:
    """Print how much faster two processes are than one."""
    taken = {}
    for workers in (1, 2):
        with tempfile.TemporaryDirectory() as folder:
            city = tiny.archive(Path(folder), count)
            start = tiny.built(city, NONE, *of(workers))
            cost = tiny.built(city, *of(workers))
        taken[workers] = cost.wall_s - start.wall_s, cost.wall_s, cost.cpu_s
        net, wall, cpu = taken[workers]
        print(
            f"{workers} processes: {wall:6.1f} s, {net:6.1f} s without the start, "
            f"{cpu:6.1f} CPU s",
            flush=True,
        )
    net, whole = (taken[1][at] / taken[2][at] for at in (0, 1))
    print(f"two are {net:.2f} times as fast as one, {whole:.2f} with the start")


def of(workers: int) -> list[str]:
    """Ask for so many processes of Beam."""
    return [
        f"--direct_num_workers={workers}",
        "--direct_running_mode=multi_processing",
    ]


def overhead(count: int) -> None:
    """Print what a build of real photographs costs beside the plain loop over them."""
    source = DATA / "taxphotos"
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "photos").mkdir()
        for path in sorted((source / "photos").iterdir())[:count]:
            shutil.copy(path, Path(folder) / "photos")
        city = Path(folder) / "city"
        listed = ["--catalogue", str(source / "catalogue.csv"), "--boards", "none"]
        own = ["--block", next((Path(folder) / "photos").iterdir()).name.split("_")[3]]
        own[1] = own[1].lstrip("0")
        where = ["index", f"{folder}/photos", "-o", str(city)]
        tiny.command([*where, *listed, *own, "-q"])
        start = tiny.command(["build", str(city), NONE])
        cost = tiny.command(["build", str(city), "--max-rejected=1"])
        stages_s = tiny.record(city)["cpu_seconds"]
        worn = {
            one
            for row in runs.read_rows(Store(str(city)), current(city), "buildings")
            for one in row["elevations"]
        }
        loop_s = looped(city, len(worn))
    beside = cost.cpu_s - start.cpu_s - stages_s
    print(f"{count} photographs: the plain loop {loop_s:7.1f} CPU s")
    print(
        f"build {cost.cpu_s:7.1f} CPU s, {cost.cpu_s / loop_s:.2f} of the loop: start "
        f"{start.cpu_s:.1f}, stages {stages_s:.1f}, Beam, tables and publishing "
        f"{beside:.1f}, which is {beside / loop_s:.3f} of the loop"
    )


def current(city: Path) -> str:
    """Name the published run."""
    return (city / "CURRENT").read_text().strip()


def looped(city: Path, worn: int) -> float:
    """Rebuild all blocks by the plain loop, and give its CPU seconds."""
    one_thread()
    networks = Models().networks(placard=False)
    rows = [r for r in manifest.read(Store(str(city))).rows if r.front is not None]
    filled: list[float] = []
    fill = inpaint.inpaint

    def timed(view: Elevation, network: Any) -> Elevation:
        before = time.process_time()
        done = fill(view, network)
        filled.append(time.process_time() - before)
        return done

    began = time.process_time()
    with mock.patch.object(inpaint, "inpaint", timed):
        for block in sorted({row.front.block for row in rows if row.front}):
            rebuilt(
                block, [r for r in rows if r.front and r.front.block == block], networks
            )
    spent = time.process_time() - began
    unworn = max(len(filled) - worn, 0)
    return spent - sum(filled) * unworn / max(len(filled), 1)


def rebuilt(name: str, rows: list[Row], networks: steps.Networks) -> None:
    """Rebuild one block."""
    shown: dict[str, tuple[bytes, list[str]]] = {}
    for row in rows:
        if row.photo and row.front:
            data = (Path(row.root) / row.photo).read_bytes()
            shown.setdefault(row.photo, (data, []))[1].append(row.front.front_id)
    fronts = list({row.front.front_id: row.front for row in rows if row.front}.values())
    reconstruct.rebuild(name, fronts, shown, networks)


PARTS = {
    "metadata": (metadata, 10_000),
    "photos": (photos, 60),
    "memory": (memory, 1000),
    "processes": (processes, 48),
    "overhead": (overhead, 2),
}


def main(words: list[str]) -> None:
    """Run the part that is named, or the first."""
    named = words[0] if words and words[0] in PARTS else "metadata"
    part, usual = PARTS[named]
    count = int(words[-1]) if words and words[-1].isdecimal() else usual
    part(count)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--in"]:
        planned(sys.argv[2])
    else:
        main(sys.argv[1:])
