"""Which facades of different photographs are worth comparing, and how alike they look.

Two facades are compared where order alone finds it likely enough that both show one
place: each asks for its likeliest few. A photograph that fits nowhere near asks for the
few of its ring that look most like it in sum (`summary`). So no facade asks for more
than a few, and the work grows with the photographs and not with their square.
"""

import itertools
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Final

import numpy as np
from scipy.sparse import csr_array

from nostalgin_core.records import Front, Texture
from nostalgin_core.views.agreement import Numbers
from nostalgin_core.views.claims import Street, alone, street
from nostalgin_core.views.likeness import likeness, probability
from nostalgin_core.views.marks import Marks, View, marks
from nostalgin_core.views.overlay import overlay
from nostalgin_core.views.stretch import Stretch
from nostalgin_core.views.summary import summary, words

ASKED: Final = 4  # others that a facade is compared with, beside those that ask for it
TARGET: Final = 0.5  # score of a target that counts
TRIED, UNLIKE = 2, 0.2  # comparisons that all find less: then it is sought elsewhere
MEET: Final = 0.1  # how probably two show one place, or they are not compared
SLIGHT: Final = 1e-3  # probability of a place, by which no pair is found
FEW: Final = 8  # targets elsewhere that one which looks like nothing near is held to
TAUGHT: Final = 200  # targets of a ring, from whose marks its words are learnt
HELD: Final = 48  # elevations in memory
MARKED: Final = 256  # elevations whose marks are in memory

Pair = tuple[Texture, Texture]
Look = Callable[[Texture], View]  # reads an elevation
Marked = Callable[[Texture], Marks]


def compared(
    fronts: Sequence[Front],
    filed: Mapping[str, Sequence[str]],
    stretches: Sequence[Stretch],
    look: Look,
) -> dict[Pair, float]:
    """Tell of pairs of facades how probably both are of one front, at even odds before.

    A photograph whose targets look like nothing near the lot that it is filed under is
    compared with targets of other lots of its ring, those most like it in sum.
    """
    seen = lru_cache(HELD)(look)

    @lru_cache(MARKED)
    def marked(texture: Texture) -> Marks:
        return marks(seen(texture))

    def told(pairs: Iterable[Pair]) -> dict[Pair, float]:
        return {(a, b): one_front(a, b, seen, marked) for a, b in along(known, pairs)}

    known = street(fronts, filed, stretches)
    near = told(worth(known))
    far = told(astray(known, near, marked))
    return dict(sorted((near | far).items()))


def worth(known: Street) -> set[Pair]:
    """List pairs of facades, of different photographs, that may show one place."""
    return {pair for ring in known.rings for pair in of_ring(known, ring)}


def of_ring(known: Street, ring: int) -> Iterable[Pair]:
    """List pairs of one ring's facades."""
    beliefs = alone(known, ring)
    rows = known.rows()
    textures = sorted(one for one in rows if one[0] in beliefs)
    if not textures:
        return
    belief = [beliefs[one[0]][rows[one]] for one in textures]
    likely = without_slight(belief)
    by_place = likely.T.tocsr()
    for i, texture in enumerate(textures):
        meet = likely[[i]] @ by_place
        # What is slight adds less than twice itself, since a belief sums to 1 at most.
        near = meet.indices[meet.data >= MEET - 2 * SLIGHT]
        others = sorted(j for j in near if textures[j][0] != texture[0])
        exact = np.array([belief[i] @ belief[j] for j in others])
        for k in np.argsort(-exact, kind="stable")[:ASKED]:
            if exact[k] >= MEET:
                a, b = sorted((texture, textures[others[k]]))
                yield a, b


def without_slight(belief: Sequence[Numbers]) -> csr_array:
    """Keep of beliefs, a row each, the places that are not slight."""
    at = [np.flatnonzero(one > SLIGHT) for one in belief]
    values = [one[places] for one, places in zip(belief, at, strict=True)]
    starts = np.cumsum([0, *map(len, at)])
    whole = (np.concatenate(values), np.concatenate(at), starts)
    return csr_array(whole, shape=(len(belief), len(belief[0])))


def astray(known: Street, near: Mapping[Pair, float], marked: Marked) -> set[Pair]:
    """List the pairs that may tell where photographs belong that fit nowhere near."""
    best: dict[Texture, list[float]] = defaultdict(list)
    for (a, b), probability_of_one in near.items():
        best[a].append(probability_of_one)
        best[b].append(probability_of_one)
    pairs: set[Pair] = set()
    for ring in known.rings:
        targets = [
            [one.texture for one in strip.stretches if one.target_score >= TARGET]
            for _, strip in sorted(known.strips.items())
            if strip.ring == ring
        ]
        shown = [own[0] for own in targets if own]
        lost = [
            mine
            for own in targets
            for mine in own
            if len(best[mine]) >= TRIED and max(best[mine]) < UNLIKE
        ]
        pairs.update(resembling(lost, shown, near, marked))
    return pairs


def resembling(
    lost: Sequence[Texture],
    shown: Sequence[Texture],
    near: Mapping[Pair, float],
    marked: Marked,
) -> Iterable[Pair]:
    """Pair what is lost with the few of what is shown that are most like it in sum."""
    if not lost:
        return
    by = words([marked(one) for one in shown[:: -(-len(shown) // TAUGHT)]])
    sums = np.array([summary(marked(one), by) for one in shown])
    for mine in lost:
        like = sums @ summary(marked(mine), by)
        pairs = (
            (min(mine, shown[j]), max(mine, shown[j]))
            for j in np.argsort(-like, kind="stable")
            if shown[j][0] != mine[0]
        )
        yield from itertools.islice((one for one in pairs if one not in near), FEW)


def along(known: Street, pairs: Iterable[Pair]) -> list[Pair]:
    """Sort pairs along the rings, so that what is held in memory serves the next."""
    at = {
        (n, place.front.lot): i
        for n, ring in known.rings.items()
        for i, place in enumerate(ring.places)
    }
    stands = {
        photo: (strip.ring, max(at[strip.ring, lot] for lot in strip.lots))
        for photo, strip in known.strips.items()
    }
    return sorted(pairs, key=lambda pair: [(stands[one[0]], one) for one in pair])


def one_front(first: Texture, second: Texture, seen: Look, marked: Marked) -> float:
    """Tell how probably two elevations are of one front."""
    found = overlay(marked(first), marked(second))
    if found is None:
        return probability(0.0, 0.0)
    alike = likeness(seen(first), seen(second), found.matrix)
    return probability(found.support, alike)
