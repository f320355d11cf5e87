"""A run over what was asked for before never writes into the tables that are shown.

It has a name of its own; if it comes to the same tables, it is the shown one again. So
a run that fails, over photographs that can't be read say, spoils no earlier one.
"""

from collections.abc import Iterator

from pipelines import site
from pipelines.build.report import PUBLISHED
from pipelines.store import Store, key_of, runs

PUBLISHING = frozenset({"places"})  # written when a run is shown


def unshown(store: Store, first: str) -> str:
    """Give a run's name, or the next in its line that no shown run has."""
    return next(one for one in line(first) if not was_shown(store, one))


def line(first: str) -> Iterator[str]:
    """Name the runs over what was asked for, one after another."""
    name = first
    while True:
        yield name
        name = key_of(name, "again")[:12]


def was_shown(store: Store, run: str) -> bool:
    """Tell whether a run was published once."""
    return store.exists(f"runs/{run}/{PUBLISHED}")


def same_as_shown(store: Store, first: str, run: str) -> str:
    """Name the run that is shown, if it was over the same and tells the same; or ""."""
    try:
        shown = store.read_bytes(site.CURRENT).decode().strip()
    except (OSError, ValueError):
        return ""
    earlier: set[str] = set()
    for one in line(first):
        if one == run:
            break
        earlier.add(one)
    names = set(runs.SCHEMAS) - PUBLISHING
    same = shown in earlier and all(alike(store, shown, run, one) for one in names)
    return shown if same else ""


def alike(store: Store, one: str, other: str, name: str) -> bool:
    """Tell whether a table of two runs is the same, part by part."""
    if runs.part_names(store, one, name) != runs.part_names(store, other, name):
        return False
    pairs = zip(
        *(runs.each_part(store, run, name) for run in (one, other)), strict=True
    )
    return all(a.equals(b) for a, b in pairs)
