"""A run over what was asked for before never writes into the tables that are shown.

It has a name of its own; if it comes to the tables of an earlier one, it is that again.
So a run that fails, over photographs that can't be read say, spoils none.
"""

from collections.abc import Iterator
from itertools import takewhile

from pipelines.store import Damaged, Store, key_of, runs


def unshown(store: Store, first: str) -> str:
    """Give a run's name, or the next in its line that no shown run has."""
    return next(one for one in line(first) if not runs.was_shown(store, one))


def line(first: str) -> Iterator[str]:
    """Name the runs over what was asked for, one after another."""
    name = first
    while True:
        yield name
        name = key_of(name, "again")[:12]


def same_as_earlier(store: Store, first: str, run: str) -> str:
    """Name the latest run over the same that was shown and tells the same; or ""."""
    earlier = list(takewhile(lambda one: one != run, line(first)))
    for one in reversed(earlier):
        if all(alike(store, one, run, name) for name in sorted(runs.OF_WORK)):
            return one
    return ""


def alike(store: Store, one: str, other: str, name: str) -> bool:
    """Tell whether a table of two runs is the same, part by part; not if damaged."""
    if runs.part_names(store, one, name) != runs.part_names(store, other, name):
        return False
    tables = (runs.each_part(store, run, name) for run in (one, other))
    try:
        return all(a.equals(b) for a, b in zip(*tables, strict=True))
    except (Damaged, FileNotFoundError):
        return False
