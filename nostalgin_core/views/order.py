"""What the order along a street tells of who is who: left to right is along the ring.

A ring runs anticlockwise seen from above, so that from the street its fronts stand from
left to right. The facades of one photograph are a chain: each shows a place of the ring
further on than the one before, or no place at all (a house across the street, a wall
behind). How far on, the gap between two facades and their widths tell; that a corner
lies between, their directions. All chains are weighed at once (forward and backward, as
for a hidden Markov model; Rabiner, 1989), but that a link may pass over facades.
"""

from collections.abc import Collection, Sequence
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.sparse import csr_array

from nostalgin_core.views.places import Ring
from nostalgin_core.views.stretch import Stretch

CORNER_DEG: Final = (45.0, 135.0)  # so much further, a facade stands round a corner
STRAIGHT_DEG: Final = 20.0
STRANGE: Final = 0.003  # of facades whose directions do not say where they stand
GAP_SD: Final = 0.08  # of both widths, of a gap between fronts that touch
LISTED_SD, ASSUMED_SD = 0.2, 0.9  # of the logarithm of a width
SEEN_SD: Final = 0.15  # of the logarithm of a width that is seen
OTHER: Final = 1.2, 1.0  # mean and deviation of what an unlisted lot takes up
WRONG: Final = 0.05  # of widths and gaps: then anything is as good
WIDEST: Final = 5.0  # of both widths: gaps and logarithms that may be
NONE: Final = 0.015  # how well a facade is told by being no front of the ring
BELIEVED: Final = 0.98  # a target score is taken for no surer than this
NEAR: Final = 2.0  # places from the filed lot at which a photograph begins
ASTRAY: Final = 0.05  # photographs that are filed under a lot far off

Numbers = Float[np.ndarray, " places"]
Links = Float[np.ndarray, "places steps"]
Belief = Float[np.ndarray, "facades places"]


def posterior(
    ring: Ring,
    filed: Collection[str],
    strip: Sequence[Stretch],
    told: Belief | None = None,
) -> Belief:
    """Give the probability of each place for each facade, from left to right.

    `filed` are the lots that the photograph is filed under; `told` weighs places by
    what else is known of them. What a row lacks to 1 is that it shows no place.
    """
    shows = np.array([emitted(ring, filed, one) for one in strip])
    if told is not None:
        shows = shows * told
    none = np.array([NONE * min(1.0, 2 - 2 * one.target_score) for one in strip])
    begin = beginning(ring, filed)
    n = len(strip)
    ways = {
        (i, j): linked(ring, strip[i], strip[j]) * np.prod([1.0, *none[i + 1 : j]])
        for i in range(n)
        for j in range(i + 1, n)
    }
    ahead, back = np.zeros_like(shows), np.zeros_like(shows)
    for j in range(n):
        reached = begin * np.prod([1.0, *none[:j]])
        ahead[j] = shows[j] * sum((ahead[i] @ ways[i, j] for i in range(j)), reached)
    ends = [float(np.prod([1.0, *none[i + 1 :]])) for i in range(n)]
    for i in reversed(range(n)):
        left = np.full(len(ring.places), ends[i])
        later = (ways[i, j] @ (shows[j] * back[j]) for j in range(i + 1, n))
        back[i] = sum(later, left)
    whole = float(np.prod(none)) + sum(ahead[i].sum() * ends[i] for i in range(n))
    return ahead * back / whole


def emitted(ring: Ring, filed: Collection[str], one: Stretch) -> Numbers:
    """Weigh places by whether a facade is one of the lot that was photographed."""
    target = float(np.clip(one.target_score, 1 - BELIEVED, BELIEVED))
    own = np.array([place.front.lot in filed for place in ring.places])
    present = np.array([place.present for place in ring.places])
    return present * np.where(own, target, 1 - target)


def beginning(ring: Ring, filed: Collection[str]) -> Numbers:
    """Weigh the places that a photograph's first facade may show: near its lot."""
    n = len(ring.places)
    own = [i for i, place in enumerate(ring.places) if place.front.lot in filed]
    if not own:
        return np.full(n, 1 / n)
    round_it = np.array([own[-1] - n, *own, own[0] + n])
    at = np.searchsorted(round_it, np.arange(n))
    apart = np.minimum(round_it[at] - np.arange(n), np.arange(n) - round_it[at - 1])
    near = np.exp(-apart / NEAR)
    return (1 - ASTRAY) * near / near.sum() + ASTRAY / n


def linked(ring: Ring, a: Stretch, b: Stretch) -> csr_array:
    """Weigh places (rows) for a facade with those (columns) for one to its right."""
    turned = (b.heading_deg - a.heading_deg + 180) % 360 - 180
    straight, round_it = (
        abs(turned) < STRAIGHT_DEG,
        CORNER_DEG[0] < turned < CORNER_DEG[1],
    )
    links = np.full(ring.on.shape, STRANGE)
    if round_it:
        links = np.where(ring.corners == 1, 1.0, links)
    if straight:
        links = np.where(ring.corners == 0, spaced(ring, a, b), links)
    links = links * proportioned(ring, a, b)
    n, most = links.shape
    starts = np.arange(n + 1) * most
    return csr_array((links.ravel(), ring.on.ravel(), starts), shape=(n, n))


def spaced(ring: Ring, a: Stretch, b: Stretch) -> Links:
    """Weigh pairs of places in one plane by the gap between two facades."""
    gap = 2 * (b.left - a.right) / (a.width + b.width)
    usual_m = (ring.width_m[:, None] + ring.width_m[ring.on]) / 2
    listed = ring.between_m / usual_m
    near = normal(gap, listed, np.hypot(GAP_SD, ASSUMED_SD * listed))
    more = normal(gap, listed + OTHER[0], np.hypot(OTHER[1], ASSUMED_SD * listed))
    told = ring.absent * near + (1 - ring.absent) * more
    return (1 - WRONG) * told + WRONG / WIDEST


def proportioned(ring: Ring, a: Stretch, b: Stretch) -> Links:
    """Weigh pairs of places by how wide two facades are to each other."""
    sd = np.where(ring.assumed, ASSUMED_SD, LISTED_SD)
    logs = np.log(ring.width_m)
    spread = np.sqrt(SEEN_SD**2 + sd[:, None] ** 2 + sd[ring.on] ** 2)
    near = normal(np.log(a.width / b.width), logs[:, None] - logs[ring.on], spread)
    return (1 - WRONG) * near + WRONG / WIDEST


def normal(x: float, mean: Links, sd: Links) -> Links:
    """Give a normal density."""
    return np.exp(-0.5 * ((x - mean) / sd) ** 2) / (sd * np.sqrt(2 * np.pi))
