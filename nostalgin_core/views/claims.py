"""Which front of its ring each facade of each photograph shows, if that is told.

A photograph is filed under one lot and shows its neighbours as well. Order and widths
(`order`) tell most, numbers alone; looks (`agreement`) tell the rest. What is less sure
than `CLAIMED` stays untold.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal, NamedTuple

import numpy as np

from nostalgin_core.records import Front, Texture
from nostalgin_core.views import agreement, order
from nostalgin_core.views.agreement import Alike, Belief
from nostalgin_core.views.places import Ring, ringed
from nostalgin_core.views.stretch import Stretch

CLAIMED: Final = 0.6  # a facade that is less probably of any front is of none
Told = Literal["own", "order", "appearance"]  # by its lot, its neighbours, its looks


@dataclass(frozen=True, slots=True)
class Claim:
    """A front that a facade shows, how probably, and how that is known.

    A corner lot's other front may be none of those listed: its name is then the one
    that `block` would give it.
    """

    front_id: str
    photo: str
    facade: int
    probability: float
    told: Told


class Strip(NamedTuple):
    """A photograph's facades from left to right, and where it is filed."""

    ring: int
    lots: frozenset[str]
    stretches: tuple[Stretch, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Street:
    """The rings of a block, and its photographs' facades along them."""

    rings: Mapping[int, Ring]
    strips: Mapping[str, Strip]

    def belief(self, photo: str, told: Belief | None = None) -> Belief:
        """Tell what one photograph makes of its facades."""
        one = self.strips[photo]
        return order.posterior(self.rings[one.ring], one.lots, one.stretches, told)

    def rows(self) -> dict[Texture, int]:
        """Tell where each facade stands in its photograph's belief."""
        return {
            one.texture: row
            for strip in self.strips.values()
            for row, one in enumerate(strip.stretches)
        }


class Heard(NamedTuple):
    """What a block's photographs believe alone, and having heard each other."""

    known: Street
    alone: Mapping[str, Belief]
    told: Mapping[str, Belief]


def claimed(
    fronts: Sequence[Front],
    filed: Mapping[str, Sequence[str]],
    stretches: Sequence[Stretch],
    alike: Alike | None = None,
) -> tuple[Claim, ...]:
    """Tell which front each facade shows: each front at most once in a photograph."""
    return claims(heard(fronts, filed, stretches, alike))


def heard(
    fronts: Sequence[Front],
    filed: Mapping[str, Sequence[str]],
    stretches: Sequence[Stretch],
    alike: Alike | None = None,
) -> Heard:
    """Let all photographs of a block tell each other what they show.

    `filed` names for each photograph the fronts that it is a record of. `alike` holds,
    for pairs of facades, the probability that both are of one front, at even odds.
    """
    known = street(fronts, filed, stretches)
    before = alone(known)
    told = before
    if alike:
        told = agreement.agreed(before, known.rows(), alike, known.belief)
    return Heard(known, before, told)


def claims(heard: Heard) -> tuple[Claim, ...]:
    """List what each facade is believed to show."""
    return tuple(
        claim
        for photo in heard.alone
        for claim in of_photo(heard.known, photo, heard.alone[photo], heard.told[photo])
    )


def owned(heard: Heard) -> dict[Texture, float]:
    """Tell how probably each facade shows a front that its photograph is filed under.

    Order, listed widths and other photographs have their say in it.
    """
    told: dict[Texture, float] = {}
    for photo, belief in heard.told.items():
        strip = heard.known.strips[photo]
        places = heard.known.rings[strip.ring].places
        own = np.array([place.front.lot in strip.lots for place in places])
        for one, row in zip(strip.stretches, belief, strict=True):
            told[one.texture] = min(1.0, float(row[own].sum()))
    return told


def alone(known: Street, ring: int | None = None) -> dict[str, Belief]:
    """Tell what each photograph, of a ring or of all, believes by itself."""
    return {
        photo: known.belief(photo)
        for photo, strip in sorted(known.strips.items())
        if ring in (None, strip.ring)
    }


def street(
    fronts: Sequence[Front],
    filed: Mapping[str, Sequence[str]],
    stretches: Sequence[Stretch],
) -> Street:
    """Sort a block's fronts into rings, and its facades into photographs."""
    by_id = {front.front_id: front for front in fronts}
    by_photo: dict[str, list[Stretch]] = defaultdict(list)
    for one in stretches:
        by_photo[one.photo].append(one)
    strips = {}
    for photo, names in filed.items():
        own = [by_id[name] for name in names if name in by_id]
        seen = by_photo.get(photo, [])
        if own and seen:
            ring = min(front.ring for front in own)
            lots = frozenset(front.lot for front in own if front.ring == ring)
            seen = sorted(seen, key=lambda one: (one.left_px, one.facade))
            strips[photo] = Strip(ring, lots, tuple(seen))
    wanted = sorted({strip.ring for strip in strips.values()})
    rings = {n: ringed([one for one in fronts if one.ring == n]) for n in wanted}
    return Street(rings, strips)


def of_photo(known: Street, photo: str, alone: Belief, heard: Belief) -> list[Claim]:
    """List the fronts that a photograph's facades are believed to show."""
    strip = known.strips[photo]
    places = known.rings[strip.ring].places
    claims: dict[str, Claim] = {}
    for one, before, after in zip(strip.stretches, alone, heard, strict=True):
        best = int(np.argmax(after))
        place, probability = places[best], min(1.0, float(after[best]))
        if place.kind == "missing" or probability < CLAIMED:
            continue
        name, how = place.front.front_id, "order"
        if place.front.lot in strip.lots:
            how = "own"
        elif before[best] < CLAIMED:
            how = "appearance"
        claim = Claim(name, photo, one.facade, probability, how)
        rival = claims.setdefault(name, claim)
        claims[name] = max(rival, claim, key=lambda each: each.probability)
    return list(claims.values())
