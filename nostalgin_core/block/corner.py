"""Corner buildings: photographs tell which lots stand round a corner.

A catalogue names one street a lot. But a photo of a corner building shows two of its
facades, and a ring runs anticlockwise: seen from the crossing, the left facade stands
on the side that ends there, the right one on the side that begins. So a lot with two
facades in one photo gets a second front at an end of its side. A second facade may be
the neighbour's or a party wall, so that house numbers beat it: a lot with a number goes
round no corner that another lot's number stands nearer to. Between lots without numbers
the photograph is the umpire, and the lot moves to the end.
"""

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from nostalgin_core.address import house_numbers
from nostalgin_core.block.pieces import DEPTH_M
from nostalgin_core.records import Front


@dataclass(frozen=True, slots=True)
class Corner:
    """Where a side of a ring ends and the next begins."""

    ring: int
    ends: int  # the side that ends here
    begins: int


def with_corners(
    fronts: Sequence[Front], two_fronted: Collection[str]
) -> tuple[Front, ...]:
    """Give every two-fronted building (by building id) of a block its second front.

    Buildings with one free corner are served first, each time anew; then those with a
    choice, the nearest corner first. A building that finds no free corner keeps its one
    front, as do those on rings of a single side.
    """
    rings: dict[int, dict[int, list[Front]]] = defaultdict(lambda: defaultdict(list))
    for front in sorted(fronts, key=lambda front: (front.ring, front.rank)):
        rings[front.ring][front.side].append(front)
    counts = {
        ring: max(max(sides) + 1, 4 if set(sides) == {0, 2} else 1)
        for ring, sides in rings.items()
    }
    taken = _known(rings, counts)
    waiting = [
        front
        for front in sorted(fronts, key=lambda front: (front.ring, front.rank))
        if building(front) in two_fronted
        and sum(building(front) == building(other) for other in fronts) == 1
    ]
    while waiting:
        choices = {
            front.front_id: _choices(
                front, rings[front.ring][front.side], counts, taken
            )
            for front in waiting
        }
        waiting = [front for front in waiting if choices[front.front_id]]
        if not waiting:
            break
        front = min(
            waiting, key=lambda one: (len(choices[one.front_id]), one.ring, one.rank)
        )
        corner = choices[front.front_id][0]
        taken.add(corner)
        waiting.remove(front)
        _stand(rings[front.ring], front, corner, fronts)
    return tuple(
        replace(front, rank=rank)
        for ring in sorted(rings)
        for rank, front in enumerate(
            front for side in sorted(rings[ring]) for front in rings[ring][side]
        )
    )


def building(front: Front) -> str:
    """Name the building that a front belongs to."""
    return f"{front.block}-{front.lot}"


def _known(
    rings: Mapping[int, dict[int, list[Front]]], counts: Mapping[int, int]
) -> set[Corner]:
    """Find corners that the catalogue gives to a lot by naming two streets.

    Such a lot is put at the ends of both sides; of several at one corner, the first.
    """
    taken = set()
    for ring, sides in rings.items():
        for side in sorted(sides):
            following = (side + 1) % counts[ring]
            lots = [front.lot for front in sides.get(following, [])]
            both = [front.lot for front in sides[side] if front.lot in lots]
            if not both or following == side or (counts[ring] == 2 and side == 1):
                continue
            _to_end(sides[side], both[-1], place=len(sides[side]))
            _to_end(sides[following], both[-1], place=0)
            taken.add(Corner(ring, side, following))
    return taken


def _to_end(side: list[Front], lot: str, *, place: int) -> None:
    """Move a lot's front to one end of its side."""
    front = next(one for one in side if one.lot == lot)
    side.remove(front)
    side.insert(min(place, len(side)), front)


def _choices(
    front: Front, side: Sequence[Front], counts: dict[int, int], taken: set[Corner]
) -> list[Corner]:
    """List the free corners of a front's side, the one it stands nearest to first."""
    count = counts[front.ring]
    if count < 2:
        return []
    place = [one.front_id for one in side].index(front.front_id)
    numbered = [house_numbers(one.address) is not None for one in side]
    last = not (numbered[place] and any(numbered[place + 1 :]))
    first = not (numbered[place] and any(numbered[:place]))
    corners = []
    if last and (count > 2 or front.side + 1 < count):
        following = (front.side + 1) % count
        corners.append(
            (len(side) - 1 - place, Corner(front.ring, front.side, following))
        )
    if first and (count > 2 or front.side > 0):
        before = (front.side - 1) % count
        corners.append((place, Corner(front.ring, before, front.side)))
    free = [(steps, corner) for steps, corner in corners if corner not in taken]
    return [corner for _, corner in sorted(free, key=lambda choice: choice[0])]


def _stand(
    sides: dict[int, list[Front]], front: Front, corner: Corner, fronts: Sequence[Front]
) -> None:
    """Put a building round a corner: its own front at the end, its second beyond."""
    own = sides[front.side]
    own.remove(next(one for one in own if one.front_id == front.front_id))
    ends = front.side == corner.ends
    other = corner.begins if ends else corner.ends
    streets = [one.street for one in sides[other]]
    second = replace(
        front,
        front_id=f"{building(front)}-{other}",
        side=other,
        street=streets[0] if streets else _missing_street(front, fronts),
        address="",
        width_m=front.depth_m or DEPTH_M,
        depth_m=front.width_m,
        width_assumed=front.depth_m is None,
    )
    if ends:
        own.append(front)
        sides[other].insert(0, second)
    else:
        own.insert(0, front)
        sides[other].append(second)


def _missing_street(front: Front, fronts: Sequence[Front]) -> str:
    """Name a side without lots: the street beyond the same corner in another ring."""
    own = {one.street for one in fronts if one.ring == front.ring}
    for ring in sorted({one.ring for one in fronts} - {front.ring}):
        streets = {one.side: one.street for one in fronts if one.ring == ring}
        for index in sorted(streets):
            if streets[index] == front.street:
                count = max(streets) + 1
                near = [streets.get((index + step) % count, "") for step in (1, -1)]
                beyond = [street for street in near if street and street not in own]
                if beyond:
                    return beyond[0]
    return ""
