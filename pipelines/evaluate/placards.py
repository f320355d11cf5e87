"""Whether photographs find their lots by their boards alone, and what that costs.

Labelled tax photographs are copied under neutral names (`photo_001.jpg`), and indexed
with a list in which each true key is hidden among ten times as many decoys, all of them
one figure away from a true one. A board that a person could read has `placard_text` in
its label. Nothing but `index` itself is asked, with a city folder of its own; the list
is drawn anew for each seed, the boards are read once.

CPU seconds are of a second reading, when the network's finds lie in the store already.
"""

import csv
import re
import shutil
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
import pyarrow.parquet as pq

from nostalgin_core.placard import Key, around
from pipelines import build, index
from pipelines.evaluate import Unmeasurable, labels, orders

DECOYS: Final = 10  # for each true key
SEEDS: Final = 5
BOARD: Final = re.compile(r"(\d+) ?-+ ?(\d+)")


def evaluate(
    folder: Path, city: Path, *, models: str = "", seeds: int = SEEDS, block: str = ""
) -> dict[str, Any]:
    """Index labelled photographs under neutral names, and compare what was joined.

    `city` is a folder to work in; what it holds of the same photographs is not made
    again.

    Raises:
        Unmeasurable: if there are no labels, or no label tells what a board says.
    """
    pairs = labels.pairs(folder, block=block)
    photos = city / "photographs"
    photos.mkdir(parents=True, exist_ok=True)
    truth: dict[str, Key | None] = {}
    titles: dict[str, str] = {}
    for number, (label, photo) in enumerate(pairs, 1):
        name = f"photo_{number:03}{photo.suffix}"
        shutil.copyfile(photo, photos / name)
        truth[name], titles[name] = told(label), photo.stem
    every = sorted({key for key in truth.values() if key is not None})
    if not every:
        raise Unmeasurable(f"{folder}: no label has a placard_text, as '993 - 5 M'")
    lists = [hidden(every, seed) for seed in range(seeds)]
    shutil.rmtree(city / "artifacts" / "placard", ignore_errors=True)
    indexed(photos, city, lists[0], models)  # what the network finds is there now
    shutil.rmtree(city / "artifacts" / "placard")
    cpu_s = indexed(photos, city, lists[0], models)
    runs = []
    for seed, keys in enumerate(lists):
        indexed(photos, city, keys, models)
        runs.append({"seed": seed} | judged(city, truth, titles))
    report = {
        "photos": len(truth),
        "readable": sum(key is not None for key in truth.values()),
        "keys": len(every),
        "listed": len(lists[0]),
        "cpu_s_a_photo": cpu_s / len(truth),
        "runs": runs,
    }
    listed = folder / orders.LIST
    if not listed.is_file():
        return report
    index_by(photos, city, *orders.hidden(listed, lists[0]), models)
    report["order"] = orders.judged(city, listed)
    return report


def told(label: dict[str, Any]) -> Key | None:
    """Read what a person could read on a board."""
    found = BOARD.search(str(label.get("placard_text") or ""))
    return (found[1], found[2]) if found else None


def hidden(keys: Sequence[Key], seed: int) -> list[Key]:
    """Hide keys among decoys that differ from one of them by one figure."""
    rng = np.random.default_rng(seed)
    decoys: set[Key] = set()
    while len(decoys) < DECOYS * len(keys):
        key = keys[int(rng.integers(len(keys)))]
        near = sorted(around(key) - set(keys) - decoys)
        decoys.add(near[int(rng.integers(len(near)))])
    return sorted({*keys, *decoys})


def indexed(photos: Path, city: Path, keys: Sequence[Key], models: str) -> float:
    """Index photographs by their boards, in this process; give its CPU seconds."""
    names = ("block", "lot", "street", "address")
    rows = [(*key, "Elm Street", 1 + 2 * n) for n, key in enumerate(keys)]
    return index_by(photos, city, names, rows, models)


def index_by(
    photos: Path,
    city: Path,
    names: Sequence[str],
    rows: Sequence[Sequence[Any]],
    models: str,
) -> float:
    """Index photographs by their boards and a list, and give the CPU seconds."""
    catalogue = city / "list.csv"
    with catalogue.open("w", newline="") as file:
        written = csv.writer(file)
        written.writerow(names)
        written.writerows(rows)
    beam = ("--stage_seconds=0",)  # no process of its own, whose seconds are not ours
    options = build.options(str(city), models=models, beam=beam)
    ask = index.Ask(partial(build.boards, options))
    began = time.process_time()
    index.index(photos, catalogue, str(city), ask=ask, force=True)
    return time.process_time() - began


def judged(
    city: Path, truth: dict[str, Key | None], titles: dict[str, str]
) -> dict[str, Any]:
    """Compare what was joined with what people read."""
    right, wrong, missed = 0, [], []
    for row in pq.read_table(city / "readings.parquet").to_pylist():
        put, key = (row["joined_block"], row["joined_lot"]), truth[row["photo"]]
        title = titles[row["photo"]]
        if any(put) and put != key:
            wrong.append(f"{title}: {'-'.join(put)}")
        elif any(put):
            right += 1
        elif key is not None:
            missed.append(f"{title}: {row['remedy']}")
    return {"right": right, "wrong": wrong, "missed": missed}


def text(report: dict[str, Any]) -> str:
    """Write a table, and the misses by name."""
    readable = report["readable"]
    hidden_among = f"{report['keys']} keys among {report['listed']} on the list"
    lines = [
        f"{report['photos']} photographs under neutral names; {hidden_among}",
        f"{readable} boards that a person can read",
        f"{report['cpu_s_a_photo']:.2f} CPU s a photograph on top of segmentation",
        f"{'seed':>4}{'right':>8}{'%':>8}{'wrong':>8}{'told':>8}",
    ]
    for run in report["runs"]:
        right, wrong, missed = run["right"], len(run["wrong"]), len(run["missed"])
        share = 100 * right / max(readable, 1)
        lines.append(f"{run['seed']:>4}{right:>8}{share:>8.1f}{wrong:>8}{missed:>8}")
    for kind in ("wrong", "missed"):
        names = sorted({one for run in report["runs"] for one in run[kind]})
        lines += [f"{kind}: {one}" for one in names]
    lines += orders.lines(report["order"]) if "order" in report else []
    return "\n".join(lines)
