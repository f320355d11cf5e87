"""The places of a ring that a facade may show, from left to right along its streets.

Beside the listed fronts there are those that no list has: the other front of a corner
lot, and lots between house numbers that jump. Each stands there with a probability.
"""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Literal

import numpy as np
from jaxtyping import Bool, Float, Int, Int32

from nostalgin_core.address import house_numbers
from nostalgin_core.records import Front

STANDS: Final = 0.97  # a listed front, by itself
AT_CORNER: Final = 0.5  # the other front of a lot at a corner: one of two has it
MISSING: Final = 0.6  # a lot that no list has, where numbers jump
NEXT_DOOR: Final = 2  # from one house number to the next on one side of a street
SOMETIMES: Final = 0.05  # so is one where they do not, or where they are not told
FARTHEST: Final = 24  # places between two facades of a photograph

Kind = Literal["listed", "corner", "missing"]


@dataclass(frozen=True, slots=True)
class Place:
    """A front of a ring, or one that may stand there."""

    front: Front
    kind: Kind
    present: float  # probability


@dataclass(frozen=True, slots=True, eq=False)
class Ring:
    """Places, and what lies between each and those that follow it along the ring.

    A column is a step further on, up to `FARTHEST` (k) of them and never all round.
    """

    places: tuple[Place, ...]
    on: Int32[np.ndarray, "n k"]  # the place that lies so many steps further on
    corners: Int[np.ndarray, "n k"]  # passed on the way
    between_m: Float[np.ndarray, "n k"]  # of fronts that surely stand
    absent: Float[np.ndarray, "n k"]  # probability that nothing else stands between
    width_m: Float[np.ndarray, " n"]
    assumed: Bool[np.ndarray, " n"]  # widths that no list tells


def places(ring: Sequence[Front]) -> tuple[Place, ...]:
    """List the places of a ring from left to right."""
    sides: dict[int, list[Front]] = {}
    for front in sorted(ring, key=lambda one: (one.rank, one.front_id)):
        sides.setdefault(front.side, []).append(front)
    order = sorted(sides)
    found = {side: with_missing(sides[side]) for side in order}
    for here, there in zip(order, [*order[1:], *order[:1]], strict=True):
        last, first = sides[here][-1], sides[there][0]
        if here != there and last.lot != first.lot:
            found[here].append(Place(other(first, last), "corner", AT_CORNER))
            found[there].insert(0, Place(other(last, first), "corner", AT_CORNER))
    return tuple(place for side in order for place in found[side])


def other(front: Front, on: Front) -> Front:
    """Give a corner lot's front on the street of another, as `block` would name it."""
    return replace(
        front,
        front_id=f"{front.block}-{front.lot}-{on.side}",
        side=on.side,
        street=on.street,
        address="",
        width_m=front.depth_m or front.width_m,
        width_assumed=True,
    )


def with_missing(side: Sequence[Front]) -> list[Place]:
    """Put a place between fronts of one side where a lot may be missing."""
    found = [Place(side[0], "listed", STANDS)]
    for before, front in itertools.pairwise(side):
        missing = replace(
            front, front_id="", lot="", address="", depth_m=None, width_assumed=True
        )
        found.append(Place(missing, "missing", jump(before, front)))
        found.append(Place(front, "listed", STANDS))
    return found


def jump(before: Front, front: Front) -> float:
    """Tell how probably a lot is missing between two fronts, by house numbers."""
    a, b = house_numbers(before.address), house_numbers(front.address)
    if a is None or b is None:
        return SOMETIMES
    apart = max(b[0] - a[1], a[0] - b[1])
    return MISSING if apart > NEXT_DOOR else SOMETIMES


def ringed(ring: Sequence[Front]) -> Ring:
    """Measure what lies between each place of a ring and those that follow it."""
    found = places(ring)
    n = len(found)
    width_m = np.array([one.front.width_m for one in found])
    listed = np.array([one.kind == "listed" for one in found])
    sides = np.array([one.front.side for one in found])
    sure_m = np.where(listed, width_m, 0.0)
    spare = np.where(listed, 0.0, [np.log1p(-one.present) for one in found])
    turns = (sides != np.roll(sides, 1)).astype(int)  # on the way to this place
    further = np.arange(1, min(FARTHEST, n - 1) + 1)
    on = ((np.arange(n)[:, None] + further) % n).astype(np.int32)
    return Ring(
        places=found,
        on=on,
        corners=np.cumsum(turns[on], axis=1),
        between_m=np.cumsum(sure_m[on], axis=1) - sure_m[on],
        absent=np.exp(np.cumsum(spare[on], axis=1) - spare[on]),
        width_m=width_m,
        assumed=np.array([one.front.width_assumed for one in found]),
    )
