"""How high a building is: what its witnesses agree on, and how sure that makes it.

A wall of width w that shows an elevation of aspect a (width / height) is w / a high:
the paper's section 3.5. That fails by a factor where the width is of another side, or
where two fronts were taken for one. Its storeys, times what a storey is high, are a
second witness, which fails by a factor where its rows of windows are miscounted; so do
the other elevations of the building. Each is a likelihood over all heights, with a part
for being quite wrong; their product with what is usual is the belief, from which height
and interval are read. What only one says weighs little, what several say much.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Float

from nostalgin_core.records import Height, Texture
from nostalgin_core.storeys import COUNTS

LOWEST_M, HIGHEST_M = 2.5, 320.0  # a stall; the tallest masonry front of the time
HEIGHTS_M: Final = np.geomspace(LOWEST_M, HIGHEST_M, 487)  # 1 % apart
STOREY_M: Final = 3.6
USUAL: Final = ((0.6, 4.5, 0.35), (0.4, 9.0, 0.8))  # share, storeys, log spread
WIDTH_SD, ASSUMED_WIDTH_SD = 0.1, 0.5  # of the logarithm
PROPORTIONS_WRONG: Final = 0.3
STOREYS_SHARPNESS: Final = 28.0  # of what a comb's score says
STOREYS_SD: Final = 0.14  # of what a storey is high, as a logarithm
STOREYS_WRONG: Final = 0.3
LISTED_SD: Final = 0.12  # storeys differ in height from house to house
LISTED_WRONG: Final = 0.05
STOREYS, WIDTH, LIST = "storeys", "width", "list"  # the witnesses
INTERVAL: Final = (0.05, 0.5, 0.95)
NEAR: Final = 0.25  # of a height
LEAST_BELIEF: Final = 0.5  # that the height lies so near, or it is assumed
LEAST_SCORE: Final = 0.1  # of a count of storeys that is told

Belief = Float[np.ndarray, " heights"]  # a density over `HEIGHTS_M`, of sum 1


@dataclass(frozen=True, slots=True)
class Shown:
    """An elevation that shows a front, and how far its proportions are trusted."""

    texture: Texture
    aspect: float
    aspect_sd: float
    score: float
    storeys: tuple[float, ...] = ()  # a score for each of `COUNTS`, if they were told
    clear: float = 1.0  # the share that a camera saw, and not smeared
    lent: bool = False  # a neighbour's photograph, which may cut its top or side


class Told(NamedTuple):
    """What one elevation says: on a wall so wide, if that is not assumed."""

    width_m: float
    assumed: bool
    shown: Shown


def belief(told: Sequence[Told], listed: float | None = None) -> Belief:
    """Weigh a building's elevations, on top of what is usual.

    Elevations of one building err together: each speaks with the weight of 1 / sqrt n.
    `listed` are the storeys that a catalogue gives, another witness.
    """
    logs = np.log(usual())
    if listed is not None:
        logs += np.log(by_list(listed))
    for width_m, assumed, one in told:
        said = np.log(proportions(width_m, one, assumed=assumed)) + np.log(storeys(one))
        logs += said / len(told) ** 0.5
    return density(logs)


def height(
    told: Sequence[Told], listed: float | None = None, known_m: float | None = None
) -> Height | None:
    """Tell a building's height, its interval and witnesses; None if nothing does.

    One that is known needs no witness; what they say of it stays told.
    """
    if not told and listed is None and known_m is not None:
        return Height(known_m, known_m, known_m, None, None, supported=True)
    if not told and listed is None:
        return None
    of = belief(told, listed)
    low_m, middle_m, high_m = quantiles(of, INTERVAL)
    near = np.abs(HEIGHTS_M / middle_m - 1) <= NEAR
    said = witnesses(told, listed)
    if known_m is not None:
        low_m = middle_m = high_m = known_m
    return Height(
        height_m=middle_m,
        low_m=low_m,
        high_m=high_m,
        by_storeys_m=said.get(STOREYS),
        by_width_m=said.get(WIDTH),
        supported=known_m is not None or bool(of[near].sum() >= LEAST_BELIEF),
        by_list_m=said.get(LIST),
        contradicting=tuple(
            name
            for name, at_m in said.items()
            if known_m is None and not low_m <= at_m <= high_m
        ),
    )


def witnesses(told: Sequence[Told], listed: float | None) -> dict[str, float]:
    """List what each witness says by itself: of elevations, the best one speaks."""
    said: dict[str, float | None] = {}
    if told:
        best = max(told, key=lambda one: (one.shown.score, one.shown.texture))
        said[STOREYS] = counted(best.shown)
        said[WIDTH] = None if best.assumed else best.width_m / best.shown.aspect
    said[LIST] = None if listed is None else listed * STOREY_M
    return {name: at_m for name, at_m in said.items() if at_m is not None}


def counted(one: Shown) -> float | None:
    """Tell the height that an elevation's storeys give by themselves, if they do."""
    if not one.storeys or max(one.storeys) < LEAST_SCORE:
        return None
    return float(COUNTS[int(np.argmax(one.storeys))] * STOREY_M)


def usual() -> Belief:
    """Give what is known of heights before anything is seen: most are low."""
    logs = np.log(HEIGHTS_M / STOREY_M)
    parts = [share * normal(logs, np.log(n), sd) for share, n, sd in USUAL]
    return density(np.log(np.sum(parts, axis=0)))


def proportions(width_m: float, one: Shown, *, assumed: bool) -> Belief:
    """Give the likelihood of heights under a wall's width and what it shows."""
    width_sd = ASSUMED_WIDTH_SD if assumed else WIDTH_SD
    sd = float(np.hypot(width_sd, one.aspect_sd / one.aspect))
    near = normal(np.log(HEIGHTS_M), np.log(width_m / one.aspect), sd)
    wrong = 1 / np.log(HIGHEST_M / LOWEST_M)
    return (1 - PROPORTIONS_WRONG) * near + PROPORTIONS_WRONG * wrong


def storeys(one: Shown) -> Belief:
    """Give the likelihood of heights under what an elevation shows of storeys."""
    if not one.storeys:
        return np.ones_like(HEIGHTS_M)
    counts, logs = np.log(COUNTS * STOREY_M), np.log(HEIGHTS_M)
    weights = np.exp(STOREYS_SHARPNESS * np.asarray(one.storeys))
    kernel = normal(logs[:, None], counts, STOREYS_SD)
    whole = kernel.sum(axis=1)
    far = whole < 1e-6
    near = np.where(far, weights.min(), kernel @ weights / np.where(far, 1.0, whole))
    return (1 - STOREYS_WRONG) * near / near.mean() + STOREYS_WRONG


def by_list(storeys: float) -> Belief:
    """Give the likelihood of heights under the storeys that a catalogue gives.

    It may be of another building or another day.
    """
    near = normal(np.log(HEIGHTS_M), np.log(storeys * STOREY_M), LISTED_SD)
    return (1 - LISTED_WRONG) * near + LISTED_WRONG / np.log(HIGHEST_M / LOWEST_M)


def normal(
    x: Float[np.ndarray, "*a"], mean: float | Float[np.ndarray, "*b"], sd: float
) -> Float[np.ndarray, "*c"]:
    """Give a normal density."""
    return np.exp(-0.5 * ((x - mean) / sd) ** 2) / (sd * np.sqrt(2 * np.pi))


def density(logs: Belief) -> Belief:
    """Turn logarithms of what is proportional to a density into one of sum 1."""
    weights = np.exp(logs - logs.max())
    return weights / weights.sum()


def quantiles(belief: Belief, shares: Iterable[float]) -> list[float]:
    """Read the heights below which these shares of a belief lie, in metres."""
    below = np.cumsum(belief) - belief / 2
    return [float(np.exp(np.interp(s, below, np.log(HEIGHTS_M)))) for s in shares]
