"""Which facade a photograph is a record of, after its street has been heard.

A photograph states of each facade how probably it is the one that is meant, by its
board and by where it stands (`matte.target`). Its street knows better where a list's
widths, the order along it and other photographs of the same lot say that the facade is
a neighbour's (`views.owned`). What the street says holds what was stated already; so it
counts only where it contradicts that, by `BESIDES` of the logarithm of odds:

    ln o' = ln o + w min(0, ln o_street - ln o + d)
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from nostalgin_core.records import Seen, Texture

CALLED: Final = 0.5  # a facade that is less probably meant is not
HEARD: Final = 0.56  # w, fitted to the labels of blocks 996 and 997
BESIDES: Final = 2.0  # d: a street knows corners and lots without a width that badly
LEAST: Final = 0.02  # no street is surer; `views.order` takes no score for surer


def meant(seen: Sequence[Seen], own: Mapping[Texture, float]) -> tuple[Seen, ...]:
    """State anew how probably each facade is meant, and take back what is not.

    The surest target of a photograph stays one: `astray` tells of those that are filed
    under a wrong lot. What a hand has told, with certainty, stays as it is.
    """
    anew = [
        replace(one, target_score=stated(one.target_score, own.get(texture(one))))
        for one in seen
    ]
    surest: dict[str, Seen] = {}
    for one in anew:
        first = surest.setdefault(one.photo, one)
        if (one.target, one.target_score) > (first.target, first.target_score):
            surest[one.photo] = one
    return tuple(
        one
        if one is surest[one.photo] or one.target_score >= CALLED
        else replace(one, target=False)
        for one in anew
    )


def stated(score: float, street: float | None) -> float:
    """Lower a probability as far as a street contradicts it; None says nothing."""
    if street is None or score in (0.0, 1.0):
        return score
    told = log_odds(street) - log_odds(score) + BESIDES
    if told >= 0:
        return score
    whole = np.log(score / (1 - score)) + HEARD * told
    return float(1 / (1 + np.exp(-whole)))


def log_odds(probability: float) -> float:
    """Give the logarithm of odds of what nobody is surer of than `LEAST` allows."""
    held = min(max(probability, LEAST), 1 - LEAST)
    return float(np.log(held / (1 - held)))


def texture(one: Seen) -> Texture:
    """Name a facade as walls do."""
    return one.photo, one.facade
