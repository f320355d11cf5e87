"""What stands in the manifest's rows: photo, front, and what a list tells of either."""

from collections.abc import Callable, Mapping, Sequence
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
) -> list[dict[str, Any]]:
    """Write down pairs of photo and front, and all that a list tells of either."""
    credits_of = {name: credit or first_credit(own) for name, own in shown.items()}
    year = years(entries)
    return [
        manifest.row_of(photo, front, root=root, credit=credits_of.get(photo, credit))
        | beside.of(photo, shown.get(photo, ()), front)
        | year(front)
        for photo, front in rows
    ]


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
