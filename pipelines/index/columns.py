"""What stands in the manifest's rows: photo, front, and what a list tells of either."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from nostalgin_core.catalogue import Entry
from nostalgin_core.records import Front
from pipelines.index import manifest
from pipelines.index.told import Told


def cells_of(
    rows: Sequence[tuple[str, Front | None]],
    shown: Mapping[str, Sequence[Entry]],
    beside: Told,
    entries: Sequence[Entry],
    *,
    root: str,
    credit: str,
) -> Iterator[dict[str, Any]]:
    """Write down pairs of photo and front, and all that a list tells of either."""
    year, alone = years(entries), of_lots_alone(rows, entries)
    for photo, front in rows:
        own = shown.get(photo, ())
        whose = credit or first_credit(own)
        if not photo and front is not None:
            own = alone[front.block, front.lot]
        told = beside.of(photo, own) | year(front)
        yield manifest.row_of(photo, front, root=root, credit=whose) | told


def of_lots_alone(
    rows: Sequence[tuple[str, Front | None]], entries: Sequence[Entry]
) -> dict[tuple[str, str], tuple[Entry, ...]]:
    """Find the first entry of each lot that has a front without a photograph."""
    bare = (front for photo, front in rows if front is not None and not photo)
    found = dict.fromkeys(((one.block, one.lot) for one in bare), tuple[Entry, ...]())
    for entry in reversed(entries) if found else ():
        if (entry.block, entry.lot) in found:
            found[entry.block, entry.lot] = (entry,)
    return found


def years(entries: Sequence[Entry]) -> Callable[[Front | None], dict[str, str]]:
    """Tell when a front's building was built, where a list tells that of any."""
    built = {(one.block, one.lot): one.built for one in reversed(entries) if one.built}

    def of(front: Front | None) -> dict[str, str]:
        lot = (front.block, front.lot) if front else ("", "")
        return {"year": built.get(lot, "")} if built else {}

    return of


def first_credit(entries: Sequence[Entry]) -> str:
    """Take the credit of the first row that gives one."""
    return next((entry.credit for entry in entries if entry.credit), "")
