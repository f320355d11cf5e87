"""Tables are merged part by part, and what is read grows as the rows do."""

import math
from pathlib import Path

import numpy as np
import pytest

from pipelines.index.asked import short
from pipelines.reprocess import merged
from pipelines.reprocess.sides import Groups
from pipelines.store import Store, runs

SIZE = 8  # rows of a part


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(runs, "PART", SIZE)


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return Store(str(tmp_path))


def rows(names: range, size: int) -> list[dict[str, object]]:
    each = {"root": "", "mtime_ns": 0, "size": size}
    return [each | {"name": f"{number}.jpg"} for number in names]


def table(store: Store, run: str, told: list[dict[str, object]], parts: int) -> None:
    """Write a run's tables in parts; all but `stamps` are empty."""
    for name in merged.SUBJECT:
        for part in range(parts):
            mine = [
                row
                for row in told
                if name == "stamps" and runs.part_of(name, row, parts) == part
            ]
            runs.write_table(store, run, name, mine, (part, parts))


def read(
    store: Store,
    monkeypatch: pytest.MonkeyPatch,
    *,
    before: int,
    after: int,
    redone: int,
    parts: int = 0,
) -> int:
    """Merge tables of so many rows; check what comes of it, and count the rows read."""
    first, new = rows(range(before), 1), rows(range(before - redone, after), 2)
    table(store, "old", first, parts or runs.parts_of(before))
    table(store, f"new/{runs.REDONE}", new, runs.parts_of(len(new)))
    gone = range(before - redone, max(before, after))
    known = np.array([short(f"{number}.jpg") for number in gone], np.uint64)
    held: list[int] = []
    one = Store.read_table

    def counted(store: Store, name: str, *more: object) -> object:
        found = one(store, name, *more)  # type: ignore[arg-type]
        held.append(found.num_rows)
        return found

    count = runs.parts_of(after)
    with monkeypatch.context() as patch:
        patch.setattr(Store, "read_table", counted)
        merged.merge(store, "new", "old", count, known)
    whole = [*first[: before - redone], *new]
    table(store, "fresh", whole, count)
    for name in runs.part_names(store, "fresh", "stamps"):
        made = store.read_table(f"runs/new/{name}")
        assert made.equals(store.read_table(f"runs/fresh/{name}"), check_metadata=False)
    return sum(held)


# The rows stay below a step, cross one by one row, go back, and cross two at once.
@pytest.mark.parametrize("step", [(2, 2), (1, 2), (2, 1), (1, 4)])
def test_rows_that_are_read_grow_as_the_rows(
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
    step: tuple[int, int],
) -> None:
    taken = {}
    for scale in (4, 16):
        before, after = (SIZE * scale * one for one in step)
        store = Store(str(tmp_path_factory.mktemp("city")))
        told = {"before": before - 1, "after": after, "redone": SIZE // 2}
        if after < before:
            told["redone"] = before - after + SIZE // 2
        taken[scale] = read(store, monkeypatch, **told) / (before + after)
    assert taken[16] <= 1.25 * taken[4]


def test_a_table_of_any_count_of_parts_is_merged(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = Store(str(tmp_path_factory.mktemp("city")))
    read(store, monkeypatch, before=70, after=75, redone=3, parts=5)


@pytest.mark.parametrize(("parts", "there"), [(8, 4), (4, 8), (8, 8), (6, 4), (5, 3)])
def test_each_row_is_found_where_it_may_stand(parts: int, there: int) -> None:
    for number in range(parts * there):
        assert number % there in runs.sources((number % parts, parts), there)
    found = sum(len(runs.sources((part, parts), there)) for part in range(parts))
    assert found == math.lcm(parts, there)


def test_a_run_is_complete_if_all_parts_of_all_tables_are(store: Store) -> None:
    table(store, "old", rows(range(9), 1), 2)
    assert merged.complete(store, "old")
    path = runs.table_path("old", "stamps", (1, 2))
    whole = store.read_table(path)
    store.write_table(path, whole.drop_columns(["size"]))
    assert not merged.complete(store, "old")
    store.remove(path)
    assert not merged.complete(store, "old")
    store.write_table(path, whole)
    assert merged.complete(store, "old")


def test_the_first_of_each_group_is_its_least_node() -> None:
    rng = np.random.default_rng(5)
    nodes = np.unique(rng.integers(0, 1 << 60, 400, dtype=np.uint64))
    groups = Groups(nodes, rng.integers(0, 50, len(nodes)))
    every = np.unique(groups.labels)[::3]
    least = [groups.nodes[groups.labels == one].min() for one in every]
    assert groups.first(every).tolist() == least
