"""Twice the rows are twice the work: counted in lines that are run, not in seconds."""

import csv
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from pipelines.check import check
from pipelines.index import index
from pipelines.store import Store

LOTS = 20  # of a block
BLOCKS = (8, 16, 32)


def archive(folder: Path, blocks: int) -> Path:
    """Write a list, and an empty file for each photograph."""
    (folder / "photos").mkdir(parents=True)
    with (folder / "list.csv").open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["photo", "block", "lot", "street", "address", "width_m", "date"])
        for n in range(blocks * LOTS):
            block, lot = n // LOTS + 1, n % LOTS + 1
            name = f"x_{block:05}_{lot:04}.jpg"
            (folder / "photos" / name).touch()
            street = f"{lot * 4 // (LOTS + 1)} Street {block}"
            out.writerow([name, block, lot, street, 2 * lot, 6 + n % 5, "1939-1941"])
    return folder


def lines_run(work: Callable[[], Any]) -> int:
    """Count the lines that are run, each turn of a loop anew."""
    count = 0

    def trace(_: FrameType, event: str, __: object) -> Any:
        nonlocal count
        count += event == "line"
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        work()
    finally:
        sys.settrace(before)
    return count


@pytest.fixture(scope="module")
def grown(tmp_path_factory: pytest.TempPathFactory) -> dict[str, list[int]]:
    counts: dict[str, list[int]] = {"index": [], "check": [], "square": []}
    for blocks in BLOCKS:
        folder = archive(tmp_path_factory.mktemp("grown") / str(blocks), blocks)
        given = str(folder / "photos"), str(folder / "list.csv"), str(folder / "city")
        counts["index"].append(lines_run(lambda given=given: index(*given)))
        store = Store(given[2])
        look = lines_run(lambda store=store: check(store, pictures=False))
        counts["check"].append(look)
        every = range(blocks * LOTS)
        counts["square"].append(
            lines_run(lambda r=every: [a + b for a in r for b in r])
        )
    return counts


def growth(counts: list[int]) -> float:
    """Tell how much more the second doubling adds than the first: 2 is linear."""
    few, some, many = counts
    return (many - some) / (some - few)


@pytest.mark.parametrize("command", ["index", "check"])
def test_twice_the_rows_are_twice_the_lines(
    command: str, grown: dict[str, list[int]]
) -> None:
    assert 1.8 < growth(grown[command]) < 2.2


def test_what_compares_all_with_all_would_be_seen(
    grown: dict[str, list[int]],
) -> None:
    assert growth(grown["square"]) > 3.5
