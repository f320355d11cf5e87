"""Which facade of which photo is which front.

Each photo is a record of one lot, and its target facades belong to that lot. A lot with
one front gets the best target. A corner lot has two, and its photo may show both: the
left one stands on the side that ends at the corner. Every photo of a lot is scored, so
that the front can wear the best.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from math import log

from nostalgin_core.block.corner import building
from nostalgin_core.records import Assignment, Front, Rejection, Seen

ENOUGH_PX = 900.0  # visible pixels: a facade of 30 by 30 tells hardly a window
NARROWEST, WIDEST = 0.04, 12.0  # width / height of a front
SURE = 0.25  # a target score below which no facade counts for a corner
SECOND = 0.6  # of the best target score, which a corner's second facade must reach
BEFORE_BOTH = 0.5  # target score of a second front whose length no list gives
MISMATCH = 2.5  # of two facades' widths to the lot's: quads at corners are rough
HALF_AREA_PX = 20_000.0  # a facade of this many pixels gets half the credit for size
HALF_SHARPNESS = 2.0  # gray levels: so does one in haze or out of focus
HALF_SPREAD = 0.15  # so does one whose aspect is known to 15 %


def assign(
    fronts: Sequence[Front],
    candidates: Mapping[str, Sequence[str]],
    seen: Sequence[Seen],
) -> tuple[Assignment | Rejection, ...]:
    """Give the facades of one block's photos to its fronts.

    `candidates` names for each photo the fronts it may show; their buildings' other
    fronts count as well. There is an assignment for each facade that shows a front, and
    a rejection for each photo that shows none.
    """
    by_photo: dict[str, list[Seen]] = defaultdict(list)
    for one in seen:
        by_photo[one.photo].append(one)
    given: list[Assignment | Rejection] = []
    for photo in sorted(candidates):
        own = _fronts_of(fronts, candidates[photo])
        given += _of_photo(photo, own, by_photo.get(photo, []))
    return tuple(given)


def two_fronted(
    fronts: Sequence[Front],
    candidates: Mapping[str, Sequence[str]],
    seen: Sequence[Seen],
) -> frozenset[str]:
    """Name the buildings that a photo shows two street fronts of.

    A second facade may be a neighbour's or a party wall. It is believed where the list
    gives the lot's depth, and both facades are as wide to each other as the lot's two
    lengths; else, where the board or the middle of the picture is before it as well.
    """
    found = set()
    for photo, names in candidates.items():
        usable = [one for one in seen if one.photo == photo and not fault(one)]
        own = [front for front in fronts if front.front_id in names]
        sure = _sure(usable)
        if len({building(front) for front in own}) == 1 and len(sure) >= 2:
            found |= {building(front) for front in own if _two_streets(front, sure)}
    return frozenset(found)


def _two_streets(front: Front, sure: Sequence[Seen]) -> bool:
    first, second = sorted(sure[:2], key=lambda one: one.left_px)
    if front.depth_m is None or front.width_assumed:
        return min(first.target_score, second.target_score) >= BEFORE_BOTH
    seen = log(first.aspect / second.aspect)
    listed = log(front.width_m / front.depth_m)
    return min(abs(seen - listed), abs(seen + listed)) <= log(MISMATCH)


def score(one: Seen) -> float:
    """Weigh a facade, from 0 to 1, comparable between photos of one front.

    It is the product of six shares: how sure the network is of the facade, how sure
    that it is the target, how much of it a camera saw unsmeared, how large it is, how
    sharp, and how well its proportions are known.
    """
    size = one.area_px / (one.area_px + HALF_AREA_PX)
    spread = one.aspect_sd / one.aspect
    return float(
        one.score
        * one.target_score
        * (0.25 + 0.75 * one.clear)
        * size
        * one.sharpness
        / (one.sharpness + HALF_SHARPNESS)
        / (1.0 + spread / HALF_SPREAD)
    )


def _fronts_of(fronts: Sequence[Front], names: Sequence[str]) -> list[Front]:
    """List the fronts of the buildings that a photo may show, in ring order."""
    buildings = {building(front) for front in fronts if front.front_id in names}
    return [front for front in fronts if building(front) in buildings]


def _of_photo(
    photo: str, fronts: Sequence[Front], seen: Sequence[Seen]
) -> list[Assignment | Rejection]:
    def rejected(reason: str, detail: str = "") -> list[Assignment | Rejection]:
        return [Rejection(photo, "assign", reason, detail)]

    if not fronts:
        return rejected("no such front", "the manifest names a front that is not there")
    if not seen:
        return rejected("no facade", "no stage before gave an elevation")
    targets = [one for one in seen if one.target]
    if not targets:
        return rejected("no target", "none of its facades is the one it is a record of")
    usable = [one for one in targets if not fault(one)]
    if not usable:
        return rejected("no usable target", fault(targets[0]))
    sure = _sure(usable)
    pairs = _corner_pair(fronts)
    if len(sure) >= 2 and pairs:
        left, right = sorted(sure[:2], key=lambda one: one.left_px)
        return [_given(pairs[0], left), _given(pairs[1], right)]
    best = max(usable, key=lambda one: (score(one), -one.facade))
    return [_given(_main(fronts), best)]


def fault(one: Seen) -> str:
    """Say why a facade is of no use; empty if it is."""
    if one.area_px < ENOUGH_PX:
        return f"facade {one.facade} has {one.area_px:.0f} pixels: too few to see it"
    if not NARROWEST <= one.aspect <= WIDEST:
        return f"facade {one.facade} is {one.aspect:.3g} times as wide as high"
    return ""


def _sure(seen: Sequence[Seen]) -> list[Seen]:
    """List the targets that count, the best first."""
    targets = [one for one in seen if one.target]
    best = max((one.target_score for one in targets), default=0.0)
    least = max(SURE, SECOND * best)
    sure = [one for one in targets if one.target_score >= least]
    return sorted(sure, key=lambda one: (-score(one), one.facade))


def _corner_pair(fronts: Sequence[Front]) -> tuple[Front, Front] | None:
    """Find two fronts of one building that meet at a corner, the left one first.

    Along a ring the left one comes right before the right one; across its start the
    ranks say the opposite, and the sides settle it.
    """
    for a in fronts:
        for b in fronts:
            meets = b.side == a.side + 1 or (b.side == 0 and a.side > 1)
            if building(a) == building(b) and a.ring == b.ring and meets:
                return a, b
    return None


def _main(fronts: Sequence[Front]) -> Front:
    """Choose the front that an archive means: the one with the house number."""
    return max(
        fronts, key=lambda front: (front.address != "", front.width_m, -front.rank)
    )


def _given(front: Front, one: Seen) -> Assignment:
    return Assignment(front.front_id, one.photo, one.facade, score(one))
