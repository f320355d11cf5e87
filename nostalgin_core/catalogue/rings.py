"""Lots become fronts, in order round each ring of their block.

Nothing but the catalogue is needed: lot numbers run round a block (anticlockwise in New
York), and house numbers run along a street, odd on one side, even on the other. A list
has slips, and one slip moves one lot: each step goes by what most lots say.

1. A lot whose number fits another street better than its own is placed there
   (`believed`); of two lots with one number, one is set aside (`crowded`).
2. A street with odd and even numbers in one block cuts it into rings (`cuts`).
3. In a ring, each street is a side; the lots tell the order of the sides (`sides`).
4. Along a side lots and numbers run together; a number that does not is set aside
   (`along`). Which way they run where lots do not tell, the other streets say
   (`directions`).

What was set aside is told, with its likeliest corrections (`told`). A lot above 100 is
a later split of the lot with its last two digits: 104 stands by 4.
"""

from collections import Counter, defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, replace

from nostalgin_core.catalogue import along
from nostalgin_core.catalogue.along import Along
from nostalgin_core.catalogue.believed import UNKNOWN, believed
from nostalgin_core.catalogue.contradictions import contradictions
from nostalgin_core.catalogue.crowded import uncrowded
from nostalgin_core.catalogue.cuts import lone, split
from nostalgin_core.catalogue.directions import Law, directions
from nostalgin_core.catalogue.doubt import Doubt
from nostalgin_core.catalogue.entry import Entry, Named, from_file_name
from nostalgin_core.catalogue.faces import faces
from nostalgin_core.catalogue.lengths import assumed_width
from nostalgin_core.catalogue.sides import sides_of, unwrapped, with_empty_sides
from nostalgin_core.catalogue.spelt import spelt
from nostalgin_core.catalogue.spots import Spot, folded, spots
from nostalgin_core.catalogue.told import told
from nostalgin_core.records import Front


@dataclass(frozen=True, slots=True, eq=False)
class _Inferred:
    """The rings of one block, side by side, and what was told of its lots."""

    rings: list[list[Along | None]]  # None: a side without lots
    by_lot: bool  # lots and numbers agree, so that lots order
    first: float  # the key of the first lot
    some: list[Spot]  # as they are listed
    doubts: list[tuple[Spot, str]]

    def ruled(self) -> list[str]:
        """List the streets whose law decides how lots stand."""
        return [
            folded(side.spots[0].street)
            for ring in self.rings
            for side in ring
            if side is not None
            and len(side.steady) > 1
            and (not self.by_lot or self.begins(side) or not side.direction)
        ]

    def warnings(self, law: Law) -> list[Doubt]:
        """Tell of the lots that were set aside, with their likeliest corrections."""
        sides = [side for ring in self.rings for side in ring if side is not None]
        misfits = [
            one for side in sides for one in along.doubts(side, law, by_lot=self.by_lot)
        ]
        doubts = [*self.doubts, *misfits]
        return told(doubts, sides, faces(self.some)) if doubts else []

    def begins(self, side: Along) -> bool:
        """Tell whether a block's lots begin on a side."""
        return any(one.key <= self.first for one in side.spots)

    def fronts(self, law: Law) -> list[Front]:
        """Order every side by the law of its street."""
        made = []
        for number, ring in enumerate(self.rings):
            sides = [
                []
                if side is None
                else along.ordered(
                    side,
                    law,
                    by_lot=self.by_lot,
                    first=self.begins(side),
                )
                for side in ring
            ]
            made += numbered(started(sides), ring=number)
        return made


def fronts(
    entries: Sequence[Entry], *, named: Named = from_file_name
) -> tuple[tuple[Front, ...], tuple[Doubt, ...]]:
    """Order all lots of a catalogue; return its fronts, block by block, and doubts.

    Where every row of a block gives its `side`, those are taken as they are.
    """
    blocks: dict[str, list[Entry]] = defaultdict(list)
    written, warnings = spelt(entries)
    for entry in written:
        blocks[entry.block].append(entry)
    given: dict[str, list[Front]] = {}
    inferred: dict[str, _Inferred] = {}
    for block, rows in blocks.items():
        some, doubts = spots(rows)
        warnings += [*contradictions(rows, named=named), *doubts]
        if all(spot.side is not None for spot in some):
            given[block] = as_given(some)
            continue
        if any(spot.side is not None for spot in some):
            text = f"block {block}: only some rows give a side; none is used"
            warnings.append(Doubt(text, block))
        inferred[block] = _inferred(some)
    law, doubts = directions(
        [
            [None if s is None else s.facts(first=one.begins(s)) for s in ring]
            for one in inferred.values()
            for ring in one.rings
        ],
        {street for one in inferred.values() for street in one.ruled()},
    )
    for one in inferred.values():
        warnings += one.warnings(law)
    made: list[Front] = []
    for block in blocks:
        made += given[block] if block in given else inferred[block].fronts(law)
    return distinct(made), (*warnings, *map(Doubt, doubts))


def _inferred(some: list[Spot]) -> _Inferred:
    """Find the rings and sides of one block."""
    placed, moved = believed(some)
    sure, crowded = uncrowded(placed)
    rings = split(sure)
    sides = with_empty_sides([sides_of(ring) for ring in rings])
    stood: list[list[Along | None]] = []
    for ring, lots in zip(sides, rings, strict=True):
        keys = dict.fromkeys((one.key, one.lot) for one in lots)
        places = {name: place for place, name in enumerate(keys)}
        stood.append(
            [along.along(unwrapped(side, places)) if side else None for side in ring]
        )
    every = [side for ring in stood for side in ring if side is not None]
    by_lot = along.trusted(every)
    doubts = [*moved, *crowded, *_alone(rings, sides), *_silent(some), *_far(placed)]
    first = min(one.key for one in some)
    return _Inferred(stood, by_lot, first, some, doubts)


def _alone(
    rings: Sequence[Sequence[Spot]], sides: Sequence[Sequence[Sequence[Spot]]]
) -> list[tuple[Spot, str]]:
    """List the lots that have a ring to themselves, or a fifth side of one."""
    fifths = [
        side[0] for ring in sides if len(ring) > 4 for side in ring if len(side) == 1
    ]
    return [
        *((one, "it has a ring to itself") for one in lone(rings)),
        *((one, "it stands alone on one of more than four sides") for one in fifths),
    ]


def _silent(some: Sequence[Spot]) -> list[tuple[Spot, str]]:
    """List the lots without a number where most have one."""
    silent = [one for one in some if not one.address]
    few = 2 * len(silent) < len(some)
    return [(one, "it has no house number") for one in silent if few]


def _far(some: Sequence[Spot]) -> list[tuple[Spot, str]]:
    """List the lots whose numbers are far from all others on their street."""
    known = faces(some)
    return [
        (one, "its number is far from the others on its street")
        for index, one in enumerate(some)
        if one.numbers and known.against(one.street, one.numbers, index)
    ]


def as_given(some: Sequence[Spot]) -> list[Front]:
    """Take sides and orders from the catalogue."""
    ordered = sorted(
        some, key=lambda one: (one.ring or 0, one.side or 0, one.key, one.number or 0)
    )
    ranks: Counter[int] = Counter()
    made = []
    for spot in ordered:
        ring = spot.ring or 0
        made.append(_front(spot, ring=ring, side=spot.side or 0, rank=ranks[ring]))
        ranks[ring] += 1
    return made


def distinct(made: Sequence[Front]) -> tuple[Front, ...]:
    """Count fronts of one name: a lot may have several on sides of the same number.

    They stand in different rings, or on two streets that make one side.
    """
    used: set[str] = set()
    unique = []
    for front in made:
        name, count = front.front_id, 1
        while name in used:
            count += 1
            name = f"{front.front_id}-{count}"
        used.add(name)
        unique.append(front if count == 1 else replace(front, front_id=name))
    return tuple(unique)


def started(sides: Sequence[list[Spot]]) -> list[list[Spot]]:
    """Begin a ring with its first side street, and never end it with an empty side."""
    starts = [index for index in range(len(sides)) if sides[index - 1] and sides[index]]
    named = [
        i for i in starts if folded(sides[i][0].street).endswith(("street", " st"))
    ]
    first = (named or starts or [0])[0]
    return [*sides[first:], *sides[:first]]


def numbered(sides: Sequence[Sequence[Spot]], *, ring: int) -> list[Front]:
    """Number the sides and the fronts along them."""
    made = []
    for side, some in enumerate(sides):
        for spot in some:
            made.append(_front(spot, ring=ring, side=side, rank=len(made)))
    return made


def _front(spot: Spot, *, ring: int, side: int, rank: int) -> Front:
    return Front(
        front_id=f"{spot.block}-{spot.lot}-{side}",
        block=spot.block,
        lot=spot.lot,
        ring=ring,
        side=side,
        rank=rank,
        street="" if spot.street == UNKNOWN else spot.street,
        address=spot.address,
        width_m=assumed_width(spot.address) if spot.width_m is None else spot.width_m,
        depth_m=spot.depth_m,
        width_assumed=spot.width_m is None,
        storeys=spot.storeys,
    )
