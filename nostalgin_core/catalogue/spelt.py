"""Of the ways in which a list writes one street, one is taken for all of its rows.

So that whoever compares names later, a table that people mend among them, sees one
street. The row keeps what it says of all else.
"""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from nostalgin_core.address import plain_name
from nostalgin_core.catalogue.doubt import Doubt
from nostalgin_core.catalogue.entry import Entry

MOST_TOLD: Final = 8  # streets, and ways of writing each
SHOWN: Final = 60  # letters of a street


def spelt(entries: Sequence[Entry]) -> tuple[list[Entry], list[Doubt]]:
    """Write each street as most rows do; tell which other ways were taken for it.

    Of ways that are as frequent the longest counts, which is the least shortened.
    """
    ways: dict[str, Counter[str]] = defaultdict(Counter)
    for one in entries:
        ways[plain_name(one.street)][one.street] += 1
    several = {plain: own for plain, own in ways.items() if len(own) > 1}
    chosen = {
        way: max(own, key=lambda one: (own[one], len(one), one))
        for own in several.values()
        for way in own
    }
    if not chosen:
        return list(entries), []
    doubts = [
        Doubt(_told(chosen[next(iter(own))], own))
        for _, own in sorted(several.items())[:MOST_TOLD]
        if len({way.casefold() for way in own}) > 1
    ]
    written = [
        replace(one, street=chosen[one.street]) if one.street in chosen else one
        for one in entries
    ]
    return written, doubts


def _told(street: str, ways: Counter[str]) -> str:
    """Say how a street is written, and how else."""
    others = [f"{way[:SHOWN]!r}" for way in sorted(ways) if way != street]
    shown = ", ".join(others[:MOST_TOLD])
    return f"{street[:SHOWN]!r} is written {shown} as well; they are taken for one"
