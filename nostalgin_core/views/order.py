"""What the order along a street tells of who is who: left to right is along the ring.

A ring runs anticlockwise seen from above, so that from the street its fronts stand from
left to right. The facades of one photograph are a chain: each shows a place of the ring
further on than the one before, or no place at all (a house across the street, a wall
behind). How far on, the gap between two facades and their widths tell; that a corner
lies between, their directions. All chains are weighed at once (forward and backward, as
for a hidden Markov model; Rabiner, 1989), but that a link may pass over facades.
"""

from collections.abc import Collection, Mapping, Sequence
from typing import Final

import numpy as np
from jaxtyping import Float
from scipy.sparse import csr_array
from scipy.special import ndtr

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
MISTAKEN: Final = 0.02  # photographs of whose targets the scores tell nothing at all
LEAST_PART: Final = -1.5  # logarithm of the part seen of a front that is cut off
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
    what else is known of them. What a row lacks to 1 is that it shows no place. A
    target may be mistaken: then another facade is as likely to be the one.
    """
    n = len(strip)
    links = {
        (i, j): linked(ring, strip[i], strip[j])
        for i in range(n)
        for j in range(i + 1, n)
    }
    begin = beginning(ring, filed)
    sure = [one.target_score for one in strip]
    belief, whole = np.zeros((n, len(ring.places))), 0.0
    for scores, share in ((sure, 1 - MISTAKEN), ([1 / n] * n, MISTAKEN)):
        shows = np.array([emitted(ring, filed, score) for score in scores])
        if told is not None:
            shows = shows * told
        weight, total = weighed(begin, shows, links, scores)
        belief += share * weight
        whole += share * total
    return belief / whole


def weighed(
    begin: Numbers,
    shows: Belief,
    links: Mapping[tuple[int, int], csr_array],
    scores: Sequence[float],
) -> tuple[Belief, float]:
    """Weigh each place for each facade, and all ways that there are."""
    none = np.array([NONE * min(1.0, 2 - 2 * score) for score in scores])
    n = len(scores)
    ways = {
        (i, j): link * np.prod([1.0, *none[i + 1 : j]])
        for (i, j), link in links.items()
    }
    ahead, back = np.zeros_like(shows), np.zeros_like(shows)
    for j in range(n):
        reached = begin * np.prod([1.0, *none[:j]])
        ahead[j] = shows[j] * sum((ahead[i] @ ways[i, j] for i in range(j)), reached)
    ends = [float(np.prod([1.0, *none[i + 1 :]])) for i in range(n)]
    for i in reversed(range(n)):
        left = np.full(len(begin), ends[i])
        later = (ways[i, j] @ (shows[j] * back[j]) for j in range(i + 1, n))
        back[i] = sum(later, left)
    whole = float(np.prod(none)) + sum(ahead[i].sum() * ends[i] for i in range(n))
    return ahead * back, float(whole)


def emitted(ring: Ring, filed: Collection[str], score: float) -> Numbers:
    """Weigh places by whether a facade is one of the lot that was photographed."""
    target = float(np.clip(score, 1 - BELIEVED, BELIEVED))
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
    """Weigh pairs of places in one plane by the gap between two facades.

    It is measured in their mean width, or in that of the one which is not cut off.
    """
    of_a = 0.5 if a.cut == b.cut else float(b.cut)
    gap = (b.left - a.right) / (of_a * a.width + (1 - of_a) * b.width)
    usual_m = of_a * ring.width_m[:, None] + (1 - of_a) * ring.width_m[ring.on]
    listed = ring.between_m / usual_m
    near = normal(gap, listed, np.hypot(GAP_SD, ASSUMED_SD * listed))
    more = normal(gap, listed + OTHER[0], np.hypot(OTHER[1], ASSUMED_SD * listed))
    told = ring.absent * near + (1 - ring.absent) * more
    return (1 - WRONG) * told + WRONG / WIDEST


def proportioned(ring: Ring, a: Stretch, b: Stretch) -> Links:
    """Weigh pairs of places by how wide two facades are to each other.

    Of one that the photo's edge cuts off, any part down to `LEAST_PART` is as likely to
    be seen.
    """
    sd = np.where(ring.assumed, ASSUMED_SD, LISTED_SD)
    logs = np.log(ring.width_m)
    spread = np.sqrt(SEEN_SD**2 + sd[:, None] ** 2 + sd[ring.on] ** 2)
    more = np.log(a.width / b.width) - (logs[:, None] - logs[ring.on])
    if a.cut and b.cut:
        near = normal(more, np.zeros_like(spread), np.hypot(spread, -LEAST_PART))
    elif a.cut or b.cut:
        less = -more if a.cut else more
        within = ndtr(less / spread) - ndtr((less + LEAST_PART) / spread)
        near = within / -LEAST_PART
    else:
        near = normal(more, np.zeros_like(spread), spread)
    return (1 - WRONG) * near + WRONG / WIDEST


def normal(x: float | Links, mean: Links, sd: Links) -> Links:
    """Give a normal density."""
    return np.exp(-0.5 * ((x - mean) / sd) ** 2) / (sd * np.sqrt(2 * np.pi))
