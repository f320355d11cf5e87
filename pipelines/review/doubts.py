"""What `index` warned of, with the corrections that it proposes, for the page.

A lot that contradicts its neighbours may be moved to where its likeliest number, or the
one that the list has, has its gap; a photograph that a row names against its own name,
to the lot of that name. What no correction says, as another address, is the list's.
"""

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from nostalgin_core.address import house_numbers
from nostalgin_core.catalogue import Doubt
from nostalgin_core.records import Front
from pipelines.console import folded
from pipelines.index import warned
from pipelines.index.row import Row
from pipelines.store import Store

MOST: Final = 200  # warnings on the page
ADDRESS: Final = re.compile(r"(?P<number>\d[^ ]*) (?P<street>.+)")

Lots = Mapping[tuple[str, str], Sequence[Front]]


@dataclass(frozen=True)
class Proposal:
    """A field that writes a correction, and what it may be filled with."""

    what: str  # key or order
    of: str  # photo or front_id
    subject: str
    now: str
    values: tuple[tuple[str, str], ...] = ()  # what is proposed, and what speaks for it


@dataclass(frozen=True)
class Shown:
    """One thing that `index` warned of, as the page has it."""

    text: str
    proposals: tuple[Proposal, ...] = ()


@dataclass(frozen=True)
class Told:
    """All that `index` warned of: alike rejections folded, and single warnings."""

    rejected: tuple[str, ...] = ()
    warnings: tuple[Shown, ...] = ()
    more: int = 0  # warnings that are left out

    @property
    def empty(self) -> bool:
        """Tell whether there is nothing to look at."""
        return not (self.rejected or self.warnings)


def told(store: Store, rows: Iterable[Row]) -> Told:
    """Gather what `index` warned of; `rows` are the manifest's, as corrected."""
    kept = warned.read(store)
    lots: dict[tuple[str, str], dict[str, Front]] = defaultdict(dict)
    for row in rows:
        if row.front is not None:
            own = lots[row.front.block, row.front.lot]
            own.setdefault(row.front.front_id, row.front)
    fronts = {key: tuple(own.values()) for key, own in lots.items()}
    some = tuple(Shown(one.text, proposed(one, fronts)) for one in kept.doubts[:MOST])
    rejected = tuple(folded(kept.rejections))
    return Told(rejected, some, len(kept.doubts[MOST:]))


def proposed(doubt: Doubt, lots: Lots) -> tuple[Proposal, ...]:
    """Propose what mends a doubt: another key of a photograph, or a front's order."""
    own = (doubt.block, doubt.lot)
    if doubt.photo:
        said = (("-".join(doubt.named), "its name"),) if doubt.named in lots else ()
        return (Proposal("key", "photo", doubt.photo, "-".join(own), said),)
    places = [*doubt.likely, *filter(None, [doubt.address])]
    block = [one for (name, _), some in lots.items() if name == own[0] for one in some]
    proposals = []
    for front in lots.get(own, ()):
        ranks = {gap(one, front, block): one for one in reversed(places)}
        ranks.pop("", None)
        said, now = tuple(ranks.items()), str(front.rank)
        proposals.append(Proposal("order", "front_id", front.front_id, now, said))
    return tuple(proposals)


def gap(address: str, front: Front, block: Sequence[Front]) -> str:
    """Find between which ranks of its ring a front of this address belongs.

    Empty: it stands there already, or nothing tells.
    """
    told = ADDRESS.fullmatch(address)
    ends = house_numbers(told["number"]) if told else None
    if told is None or ends is None:
        return ""
    along = sorted(
        (one.rank, number[0])
        for one in block
        if one.ring == front.ring
        and one.front_id != front.front_id
        and one.street.casefold() == told["street"].casefold()
        and (number := house_numbers(one.address)) is not None
        and number[0] % 2 == ends[0] % 2
    )
    for (before, low), (after, high) in pairwise(along):
        if min(low, high) < ends[0] < max(low, high):
            within = before < front.rank < after
            return "" if within else f"{(before + after) / 2:g}"
    return ""
