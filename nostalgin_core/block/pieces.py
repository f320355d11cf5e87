"""What each side of a ring is made of: a piece for every building that stands on it.

Every corner belongs to one building, which has a piece on both its sides. The pieces of
a side are then fitted to its length, once the ring is closed.
"""

import itertools
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy

from nostalgin_core.address import house_numbers, street_width
from nostalgin_core.records import Front

DEPTH_M = 18.0  # a lot is commonly 60 to 100 feet deep
KNOWN_SD, ASSUMED_SD = 0.03, 0.4  # relative, of a width
DEPTH_SD = 0.25  # of a width that is another front's depth
GROWTH = 1.35  # an assumed width grows by no more: beyond, an assumed wall stands
DOUBT = 0.03  # of a side's length, as of a width that is known
WHOLE = 0.75  # of the opposite side's length, from which one front fills its side
UNKNOWN_JUMP = 3  # next doors are 2 apart: rather there than between those


@dataclass(frozen=True, slots=True)
class Piece:
    """A stretch of one side that belongs to one building."""

    building_id: str
    front_id: str | None  # None: the side wall of a corner building
    width_m: float
    width_sd: float  # relative
    depth_m: float
    lot: str
    street: str
    numbers: tuple[int, int] | None  # house numbers, to see where lots are missing
    depth_listed: bool = False


def pieces(fronts: Sequence[Front]) -> list[list[Piece]]:
    """Sort fronts into sides; a side without fronts stays empty.

    Fronts of one lot that do not meet at a corner (on opposite streets, say) stand for
    a building each; all but the first get the side's number behind their name.
    """
    present = {front.side for front in fronts}
    count = 4 if present == {0, 2} else max(present) + 1
    sides: list[list[Front]] = [[] for _ in range(count)]
    for front in sorted(fronts, key=lambda front: front.rank):
        sides[front.side].append(front)
    names = _names(sides)
    return [[_piece(front, names[front.front_id]) for front in side] for side in sides]


def _piece(front: Front, name: str) -> Piece:
    return Piece(
        building_id=name,
        front_id=front.front_id,
        width_m=front.width_m,
        width_sd=ASSUMED_SD if front.width_assumed else KNOWN_SD,
        depth_m=front.depth_m or DEPTH_M,
        lot=front.lot,
        street=front.street,
        numbers=house_numbers(front.address),
        depth_listed=front.depth_m is not None,
    )


def _names(sides: Sequence[Sequence[Front]]) -> dict[str, str]:
    """Name the building of each front; fronts that meet at a corner share one."""
    following = {
        b[0].front_id: a[-1].front_id
        for a, b in _corners(sides)
        if a and b and a[-1].lot == b[0].lot and a[-1].front_id != b[0].front_id
    }
    leaders: dict[str, str] = {}
    for front_id in (front.front_id for side in sides for front in side):
        leader, passed = front_id, {front_id}
        while leader in following and following[leader] not in passed:
            leader = following[leader]
            passed.add(leader)
        leaders[front_id] = min(passed) if leader in following else leader
    names: dict[str, str] = {}
    used: set[str] = set()
    for front in (front for side in sides for front in side):
        leader = leaders[front.front_id]
        if leader not in names:
            plain = f"{front.block}-{front.lot}"
            name = plain if plain not in used else f"{plain}-{front.side}"
            names[leader] = name if name not in used else front.front_id
            used.add(names[leader])
    return {front_id: names[leader] for front_id, leader in leaders.items()}


def with_corners(sides: Sequence[Sequence[Piece]]) -> list[list[Piece]]:
    """Give every corner to one building, which then has a piece on both sides.

    Where no building has fronts on both, it is the last of the side that ends or the
    first of the side that starts: see `_claim`. Its depth is its other width. A side
    without fronts belongs to its neighbour that comes first, to its far corner.
    """
    whole = [list(side) for side in sides]
    count = len(sides)
    held = Counter(
        a[-1].building_id
        for a, b in _corners(sides)
        if a and b and a[-1].building_id == b[0].building_id
    )
    for here in range(count if count > 2 else count - 1):
        there = (here + 1) % count
        last = whole[here][-1] if whole[here] else None
        first = whole[there][0] if whole[there] else None
        if last and first and last.building_id == first.building_id:
            continue
        if last and first:
            ends = _claim(sides, here, last, held, at_end=True)
            begins = _claim(sides, there, first, held, at_end=False)
            owner = last if ends <= begins else first
        else:
            owner = first or (last if sides[here] else None)
        if owner is None:
            continue
        held[owner.building_id] += 1
        if owner is last:
            whole[there].insert(0, _round_the_corner(owner))
        else:
            whole[here].append(_round_the_corner(owner))
    return whole


def _corners(
    sides: Sequence[Sequence[Any]],
) -> list[tuple[Sequence[Any], Sequence[Any]]]:
    """Pair each side with the one after it."""
    following = [*sides[1:], *(sides[:1] if len(sides) > 2 else [])]
    return list(zip(sides, following, strict=False))


def _claim(
    sides: Sequence[Sequence[Piece]],
    side: int,
    piece: Piece,
    held: Counter[str],
    *,
    at_end: bool,
) -> tuple[bool, bool, float, int]:
    """Rank a building's claim to a corner; the smaller one wins.

    A building that holds a corner already, or that is alone on its side and nearer in
    lot to the other corner, stands back, unless its front is as long as the whole side.
    Then the wider street counts, for corner lots have their address on the avenue;
    then the side with fewer fronts.
    """
    own = sides[side]
    alone = len(own) == 1 and not _whole_side(sides, side)
    other = sides[(side - 1) % len(sides) if at_end else (side + 1) % len(sides)]
    near = sides[(side + 1) % len(sides) if at_end else (side - 1) % len(sides)]
    elsewhere = (
        alone
        and bool(near and other)
        and _lots_apart(piece, other[-1 if at_end else 0])
        < _lots_apart(piece, near[0 if at_end else -1])
    )
    return (
        alone and held[piece.building_id] > 0,
        elsewhere,
        -street_width(piece.street),
        len(own),
    )


def _whole_side(sides: Sequence[Sequence[Piece]], side: int) -> bool:
    """Tell whether a side's one front is about as long as the opposite side."""
    if len(sides) != 4 or not sides[side]:
        return False
    opposite_m = sum(piece.width_m for piece in sides[(side + 2) % 4])
    return sides[side][0].width_m > WHOLE * opposite_m > 0


def _lots_apart(a: Piece, b: Piece) -> float:
    """Tell how far two lots are apart by their numbers, without regard to letters."""
    numbers = [int(one.lot) for one in (a, b) if one.lot.isdecimal()]
    return float(abs(numbers[0] - numbers[1])) if len(numbers) == 2 else 0.0


def _round_the_corner(piece: Piece) -> Piece:
    return replace(
        piece,
        front_id=None,
        width_m=piece.depth_m,
        width_sd=DEPTH_SD,
        depth_m=piece.width_m,
        numbers=None,
        depth_listed=False,
    )


def relative_sd(side: Sequence[Piece]) -> float:
    """Tell how far a side's length is known, from its pieces."""
    sds_m = [piece.width_m * piece.width_sd for piece in side]
    return float(np.hypot.reduce(sds_m)) / sum(piece.width_m for piece in side)


def fitted(side: Sequence[Piece], length_m: float) -> list[tuple[float, float]]:
    """Fit a side's pieces to its length; return each one's start and end along it.

    A piece changes by a factor exp(s^2 k) with its relative spread s and one k for the
    side, so that what was measured well hardly moves. Where that would stretch an
    assumed width beyond `GROWTH`, the rest is left open where the house numbers jump
    most, for an assumed wall (`chain`); an opening under `DOUBT` of the side is closed
    by scaling, for no width is known better. A building alone from corner to corner is
    stretched, for both its corners are its own.
    """
    if not side:
        return []
    width_m = np.array([piece.width_m for piece in side])
    variance = np.array([piece.width_sd**2 for piece in side])

    def surplus(k: float) -> float:
        return float((width_m * np.exp(variance * k)).sum()) - length_m

    most = float(np.log(GROWTH)) / ASSUMED_SD**2
    least = float(np.log(length_m / 2 / width_m.sum()) / variance.min())
    k = (
        most
        if surplus(most) <= 0
        else scipy.optimize.brentq(surplus, min(least, -1.0), most)
    )
    width_m = width_m * np.exp(variance * k)
    open_m = length_m - float(width_m.sum())
    if len(side) == 1 or open_m < DOUBT * length_m:
        width_m, open_m = width_m * length_m / width_m.sum(), 0.0
    starts_m = np.concatenate([[0.0], np.cumsum(width_m)[:-1]])
    starts_m[_widest_jump(side) + 1 :] += open_m
    return [(float(a), float(a + w)) for a, w in zip(starts_m, width_m, strict=True)]


def _widest_jump(side: Sequence[Piece]) -> int:
    """Tell after which piece lots are most likely missing."""
    jumps = [
        max(b.numbers[0] - a.numbers[1], a.numbers[0] - b.numbers[1])
        if a.numbers and b.numbers
        else UNKNOWN_JUMP
        for a, b in itertools.pairwise(side)
    ]
    return int(np.argmax(jumps)) if jumps else 0
