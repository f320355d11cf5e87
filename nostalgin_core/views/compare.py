"""Which facades of different photographs are worth comparing, and how alike they look.

Two facades are compared where order alone finds it likely enough that both show one
place: each asks for its likeliest few, so that the work grows with the photographs and
not with their square.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Final

import numpy as np

from nostalgin_core.records import Front, Texture
from nostalgin_core.views.claims import Street, alone, street
from nostalgin_core.views.likeness import likeness, probability
from nostalgin_core.views.marks import Marks, View, marks
from nostalgin_core.views.overlay import overlay
from nostalgin_core.views.stretch import Stretch

ASKED: Final = 4  # others that a facade is compared with, beside those that ask for it
TARGET: Final = 0.5  # score of a target that counts
TRIED, UNLIKE = 2, 0.2  # comparisons that all find less: then it is sought elsewhere
MEET: Final = 0.1  # how probably two show one place, or they are not compared
HELD: Final = 48  # elevations in memory

Pair = tuple[Texture, Texture]
Look = Callable[[Texture], View]  # reads an elevation


def compared(
    fronts: Sequence[Front],
    filed: Mapping[str, Sequence[str]],
    stretches: Sequence[Stretch],
    look: Look,
) -> dict[Pair, float]:
    """Tell of pairs of facades how probably both are of one front, at even odds before.

    A photograph whose targets look like nothing near the lot that it is filed under is
    compared with the targets of all other lots of its ring.
    """

    @lru_cache(HELD)
    def seen(texture: Texture) -> tuple[View, Marks]:
        view = look(texture)
        return view, marks(view)

    known = street(fronts, filed, stretches)
    along = places_of(known)
    alike: dict[Pair, float] = {}
    for pairs in (worth, astray):
        # Neighbours one after the other, so that few elevations are read twice.
        for a, b in sorted(
            pairs(known, alike), key=lambda pair: (along[pair[0]], pair)
        ):
            alike[a, b] = told(seen(a), seen(b))
    return {pair: alike[pair] for pair in sorted(alike)}


def places_of(known: Street) -> dict[Texture, tuple[int, int]]:
    """Tell where along its ring each facade most probably stands."""
    beliefs = alone(known)
    return {
        texture: (known.strips[texture[0]].ring, int(beliefs[texture[0]][row].argmax()))
        for texture, row in known.rows().items()
    }


def worth(known: Street, alike: Mapping[Pair, float]) -> set[Pair]:
    """List pairs of facades, of different photographs, that may show one place."""
    pairs = {pair for ring in known.rings for pair in of_ring(known, ring)}
    return pairs - set(alike)


def of_ring(known: Street, ring: int) -> Iterable[Pair]:
    """List pairs of one ring's facades."""
    beliefs = alone(known, ring)
    rows = known.rows()
    textures = sorted(one for one in rows if one[0] in beliefs)
    if not textures:
        return
    belief = np.array([beliefs[photo][rows[photo, n]] for photo, n in textures])
    photos = np.array([photo for photo, _ in textures])
    for i, texture in enumerate(textures):
        meet = belief @ belief[i]
        meet[photos == texture[0]] = 0
        for j in np.argsort(-meet, kind="stable")[:ASKED]:
            if meet[j] >= MEET:
                a, b = sorted((texture, textures[j]))
                yield a, b


def astray(known: Street, alike: Mapping[Pair, float]) -> set[Pair]:
    """List the pairs that may tell where photographs belong that fit nowhere near."""
    best: dict[Texture, list[float]] = defaultdict(list)
    for (a, b), probability_of_one in alike.items():
        best[a].append(probability_of_one)
        best[b].append(probability_of_one)
    targets = {
        photo: [one.texture for one in strip.stretches if one.target_score >= TARGET]
        for photo, strip in sorted(known.strips.items())
    }
    return {
        (min(mine, theirs), max(mine, theirs))
        for photo, own in targets.items()
        for mine in own
        if len(best[mine]) >= TRIED and max(best[mine]) < UNLIKE
        for other, strip in known.strips.items()
        if other != photo and strip.ring == known.strips[photo].ring
        for theirs in targets[other][:1]
    } - set(alike)


def told(first: tuple[View, Marks], second: tuple[View, Marks]) -> float:
    """Compare two elevations."""
    found = overlay(first[1], second[1])
    if found is None:
        return probability(0.0, 0.0)
    return probability(found.support, likeness(first[0], second[0], found.matrix))
