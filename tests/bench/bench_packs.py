"""What a build leaves on disk, single and packed, and what a million rows take.

    python tests/bench/bench_packs.py [city, to be copied] [rows, default 100000]

Without a city, artifacts of the sizes that block 993's had stand for one.
"""

import os
import resource
import shutil
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow as pa

from nostalgin_core.records import Front
from pipelines.build.report import wanted
from pipelines.index import manifest, source
from pipelines.index.asked import ask
from pipelines.store import Store, packing
from pipelines.store.packing import artifact, pack
from pipelines.store.store import key_of

FOLDER = "artifacts/matte/1-abc"
COUNT, BYTES = 4000, 125_000  # 8 files and 1 MB a photo: 500 photos
FRONT = Front("1-1-0", "1", "1", 0, 0, 0, "Elm Street", "1", 8.0, None, False)  # noqa: FBT003


def on_disk(folder: Path) -> tuple[int, int, int]:
    """Count files, their bytes and the bytes that their disk gave them."""
    found = [one.stat() for one in folder.rglob("*") if one.is_file()]
    return (
        len(found),
        sum(one.st_size for one in found),
        sum(512 * one.st_blocks for one in found),
    )


def painted(store: Store) -> list[str]:
    """Keep artifacts of random bytes, which no packing makes smaller."""
    rng = np.random.default_rng(7)
    keys = [key_of(str(number)) for number in range(COUNT)]
    for key in keys:
        store.keep(artifact(FOLDER, key), pa.table({"x": [rng.bytes(BYTES)]}))
    return keys


def found_s(store: Store, folder: str, keys: list[str]) -> float:
    """Time how long it takes to find all of them done, in a process that starts."""
    fresh = replace(store, era=str(time.time_ns()))
    began = time.perf_counter()
    assert all(fresh.verdict(artifact(folder, key)) is not False for key in keys)
    return time.perf_counter() - began


def packs(city: str) -> None:
    """Pack a city, or painted artifacts, and print what that changes."""
    with tempfile.TemporaryDirectory() as top:
        packing.LEAST = 1  # type: ignore[misc] - a small city, too
        store = Store(f"{top}/city")
        if city:
            shutil.copytree(f"{city}/artifacts", f"{top}/city/artifacts")
        else:
            painted(store)
        below = Path(top, "city", "artifacts")
        folders = [
            one.relative_to(f"{top}/city").as_posix()
            for one in sorted(below.glob("*/*"))
            if one.parent.name != "aside"
        ]
        keys = {folder: sorted(store.listed(folder)) for folder in folders}
        before = on_disk(below)
        loose = sum(found_s(store, *one) for one in keys.items())
        began = time.perf_counter()
        for folder in folders:
            pack(store, folder)
        spent = time.perf_counter() - began
        after = on_disk(below)
        packed = sum(found_s(store, *one) for one in keys.items())
    told = zip(("files", "bytes", "bytes on disk"), before, after, strict=True)
    for what, old, new in told:
        print(f"{what:14} {old:12,} single {new:12,} packed  {old / new:8.2f} times")
    print(
        f"packed in {spent:.1f} s; all found done: {loose:.3f} s single, "
        f"{packed:.3f} s packed, {loose / packed:.1f} times"
    )


def listed(store: Store, count: int) -> None:
    """Write a manifest of so many rows, in a process that takes its memory with it."""
    child = os.fork()
    if not child:
        cells = [
            manifest.row_of(
                f"{n}.jpg",
                replace(FRONT, front_id=str(n), block=str(n // 50), rank=n % 50),
                root="photos",
                credit="",
            )
            for n in range(count)
        ]
        manifest.write(store, cells)
        os._exit(0)
    os.waitpid(child, 0)


def rows(count: int) -> None:
    """Ask for many rows, and print what it takes to check and write them."""
    with tempfile.TemporaryDirectory() as top:
        store = Store(top)
        listed(store, count)
        before, began = peak_mb(), time.process_time()
        todo = ask(store, source.found(store), "run")
        spent, pieces = time.process_time() - began, len(todo.pieces())
        print(
            f"{count:,} rows asked for: {spent:.1f} CPU s, {peak_mb() - before:.0f} MB "
            f"more at the peak; {todo.photos:,} photos in {pieces} pieces"
        )
        began = time.process_time()
        wanted(store, "run")
        spent = time.process_time() - began
        print(f"and read for the check: {spent:.1f} CPU s, {peak_mb() - before:.0f} MB")


def peak_mb() -> float:
    """Tell the most memory that this process has held."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


if __name__ == "__main__":
    words = sys.argv[1:]
    rows(int(words[-1]) if words and words[-1].isdecimal() else 100_000)
    packs(words[0] if words and not words[0].isdecimal() else "")
