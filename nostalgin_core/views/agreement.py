"""What photographs tell each other: facades that look alike show one place.

Two chains (`order`) meet where two facades may show one place of the ring. How alike
these two look weighs their meeting there, against not meeting. Each tells the other
what it believes, but for what it was told by it (belief propagation; Pearl, 1988), in
rounds, since photographs meet in circles.
"""

from collections import defaultdict
from collections.abc import Callable, Mapping
from typing import Final

import numpy as np
from jaxtyping import Float

from nostalgin_core.records import Texture

ROUNDS: Final = 4
TRUSTED: Final = 0.7  # of the logarithm of odds: views of one front err together
ODDS: Final = (0.3, 200.0)  # views of one front may look unlike; few of two look alike
LEAST: Final = 1e-9

Numbers = Float[np.ndarray, " places"]
Belief = Float[np.ndarray, "facades places"]
Alike = Mapping[tuple[Texture, Texture], float]  # probability that both show one front
Anew = Callable[[str, Belief], Belief]  # a photograph's belief, given what it is told


def agreed(
    alone: Mapping[str, Belief],
    rows: Mapping[Texture, int],
    alike: Alike,
    anew: Anew,
) -> dict[str, Belief]:
    """Give each photograph's belief about its facades, having heard the others.

    `rows` tells where a facade stands in its photograph's belief; of others, nothing
    is heard.
    """
    odds = odds_of(
        {pair: alike[pair] for pair in sorted(alike) if rows.keys() >= set(pair)}
    )
    beliefs, said = dict(alone), dict.fromkeys(odds, 1.0)
    for _ in range(ROUNDS if odds else 0):
        said = {
            (a, b): 1 + (odd - 1) * without(beliefs[a[0]][rows[a]], said[b, a])
            for (a, b), odd in odds.items()
        }
        told = {photo: np.ones_like(belief) for photo, belief in alone.items()}
        for (_, b), message in said.items():
            told[b[0]][rows[b]] *= message
        beliefs = {photo: anew(photo, told[photo]) for photo in alone}
    return beliefs


def odds_of(alike: Alike) -> dict[tuple[Texture, Texture], float]:
    """Tell what looks are worth, either way round, given that fronts may look alike.

    Stated probabilities are at even odds. A facade shows the front of at most one of
    another photograph's: where it looks like several, it tells little, and nothing in a
    row of identical houses.
    """
    plain = {pair: max(p, LEAST) / max(1 - p, LEAST) for pair, p in alike.items()}
    plain |= {(b, a): odd for (a, b), odd in plain.items()}
    rivals: dict[tuple[Texture, str], list[float]] = defaultdict(list)
    for (a, (photo, _)), odd in sorted(plain.items()):
        rivals[a, photo].append(odd)

    def worth(a: Texture, b: Texture, odd: float) -> float:
        others = [1.0, *rivals[a, b[0]], *rivals[b, a[0]]]
        usual = (sum(others) - 2 * odd) / max(len(others) - 2, 1)
        return float(np.clip((odd / max(usual, 1.0)) ** TRUSTED, *ODDS))

    return {(a, b): worth(a, b, odd) for (a, b), odd in plain.items()}


def without(belief: Numbers, told: Numbers | float) -> Numbers:
    """Take from a belief what it was told; what it lacks to 1 is that of no place."""
    before = belief / told
    whole = before.sum() + max(0.0, 1 - float(belief.sum()))
    return before / max(whole, LEAST)
