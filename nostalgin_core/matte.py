"""Each front gets a soft outline, and what stands before it is taken off.

The network's outlines are right to a few pixels; closed-form matting moves them to the
edges that the camera saw. Three kinds of boundary are told apart:

- a front against the sky, the street or a wall is matted along its amodal outline;
- a front against its neighbour: the neighbour's sure region is this one's background,
  and where the two still overlap they share the pixel, so alphas add up to 1 at most;
- a front against what hides it: all occluders are matted together, once, and then
  visible alpha = alpha of the whole front * (1 - alpha of the occluders).
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np
from jaxtyping import Float32

from nostalgin_core import closed_form, facade
from nostalgin_core.arrays import Gray, Mask, Probability
from nostalgin_core.laplacian import Belief
from nostalgin_core.records import Facade, Instance, Matted, Occluder, Photo, Rejection
from nostalgin_core.trimap import (
    BACKGROUND,
    FOREGROUND,
    UNKNOWN,
    Trimap,
    signed_distance,
    trimap,
)

EPSILON: Final = 1e-5  # film grain has a standard deviation of 0.003 to 0.01
BELIEF: Final = 0.02  # in the network, where the image shows no edge
_MARGIN_PX: Final = 4  # round a band: a window, and the known pixels beside it

_Soft = Float32[np.ndarray, "h w"]
_Solve = Callable[[Trimap, Probability], _Soft]


def matte(
    photo: Photo,
    instances: Sequence[Instance],
    *,
    least: float = 0.5,
    facade_px: tuple[float, float] = (3.0, 8.0),
    occluder_px: tuple[float, float] = (2.0, 6.0),
    epsilon: float = EPSILON,
    belief: float = BELIEF,
) -> Matted | Rejection:
    """Arrange a photo's fronts, and give each its soft visible membership.

    Args:
        photo: Outside its frame every alpha is 0.
        instances: What the network found.
        least: The probability from which an occluder hides.
        facade_px: How far a front's band reaches from its outline, at least and at
            most.
        occluder_px: The same for what hides fronts.
        epsilon: See `closed_form.alpha`.
        belief: The weight of the network's probability inside the band.
    """
    fronts = facade.arrange(photo, instances)
    if isinstance(fronts, Rejection):
        return fronts
    shape = photo.image.shape
    x0, y0, x1, y1 = photo.frame
    cut = np.s_[y0:y1, x0:x1]
    light = np.ascontiguousarray(photo.image[cut])
    solve = partial(soft, light, epsilon=epsilon, belief=belief)
    hiders = [i for i in instances if i.category != "facade"]
    wholes = [front.amodal[cut] for front in fronts]
    near = grown(np.any(wholes, axis=0), facade_px[1])
    hidden = _hidden(solve, highest(hiders, shape)[cut], near, least, occluder_px)
    alphas = []
    for i, front in enumerate(fronts):
        others = np.any([np.zeros_like(near), *wholes[:i], *wholes[i + 1 :]], axis=0)
        likely = highest([_source(front, instances, least)], shape)[cut]
        known, likely = outline(wholes[i], likely, others, px=facade_px)
        # What is hidden anyway is not asked: the outline has the last word there.
        asked = (known != UNKNOWN) | (hidden < 0.95)
        sure = np.where(wholes[i], FOREGROUND, BACKGROUND).astype(np.uint8)
        alphas.append(solve(np.where(asked, known, sure), likely))
    share = (1.0 - hidden) / np.maximum(np.sum(alphas, axis=0), 1.0)
    return Matted(
        tuple(
            replace(front, alpha=_placed(alpha * share, cut, shape))
            for front, alpha in zip(fronts, alphas, strict=True)
        ),
        tuple(_occluder(i, _placed(hidden, cut, shape), least) for i in hiders),
    )


def soft(
    image: Gray, known: Trimap, likely: Probability, *, epsilon: float, belief: float
) -> _Soft:
    """Matte the part of an image round the unknown band; the rest is known."""
    result = (known == FOREGROUND).astype(np.float32)
    band = (known != FOREGROUND) & (known != BACKGROUND)
    if not band.any():
        return result
    part = _around(band)
    prior = Belief(likely[part], belief)
    result[part] = closed_form.alpha(
        image[part], known[part], prior=prior, epsilon=epsilon
    )
    return result


def highest(instances: Sequence[Instance], shape: tuple[int, int]) -> _Soft:
    """Lay instances over one another; the highest probability counts."""
    result = np.zeros(shape, np.float32)
    for instance in instances:
        x0, y0, x1, y1 = instance.box
        there = result[y0:y1, x0:x1]
        np.maximum(there, instance.probability, out=there)
    return result


def grown(mask: Mask, distance_px: float) -> Mask:
    """Add what lies within a distance of a mask."""
    return signed_distance(mask) >= -distance_px


def _hidden(
    solve: _Solve, likely: _Soft, near: Mask, least: float, px: tuple[float, float]
) -> _Soft:
    """Matte all that hides fronts, where there are fronts to hide."""
    known = trimap(likely, least_px=px[0], most_px=px[1])
    sure = np.where(likely > least, FOREGROUND, BACKGROUND).astype(np.uint8)
    return solve(np.where(near, known, sure), likely)


def outline(
    whole: Mask, likely: _Soft, others: Mask, *, px: tuple[float, float]
) -> tuple[Trimap, _Soft]:
    """Draw a front's trimap along its amodal outline, and mend its probability.

    The probability serves where it agrees with the outline, at which neighbours were
    told apart. What is surely a neighbour's is background.
    """
    agreed = np.where(whole, np.maximum(likely, 0.5), np.minimum(likely, 0.49))
    agreed = agreed.astype(np.float32)
    known = trimap(agreed, least_px=px[0], most_px=px[1])
    known[signed_distance(others) > px[0]] = BACKGROUND
    return known, agreed


def _source(front: Facade, instances: Sequence[Instance], least: float) -> Instance:
    """Find the instance that a front was made from: the one that covers most of it."""
    facades = [i for i in instances if i.category == "facade"]

    def common(instance: Instance) -> float:
        x0, y0, x1, y1 = instance.box
        claimed = instance.probability > least
        both = np.count_nonzero(claimed & front.mask[y0:y1, x0:x1])
        either = np.count_nonzero(claimed) + np.count_nonzero(front.mask) - both
        return both / max(1, either)

    return max(facades, key=common)


def _occluder(instance: Instance, hidden: _Soft, least: float) -> Occluder:
    """Give an occluder its share of what was matted, within a little of its mask."""
    mask = np.zeros(hidden.shape, bool)
    x0, y0, x1, y1 = instance.box
    mask[y0:y1, x0:x1] = instance.probability > least
    reach = _around(mask) if mask.any() else np.s_[0:0, 0:0]
    mask[reach] = grown(mask[reach], float(_MARGIN_PX)) & (hidden[reach] > 0.5)
    return Occluder(instance.category, instance.score, mask)


def _around(mask: Mask) -> tuple[slice, slice]:
    """Cut out a mask's bounding box, with a margin, inside the image."""
    parts = []
    for axis in (1, 0):
        places = np.flatnonzero(mask.any(axis=axis))
        start = max(0, int(places[0]) - _MARGIN_PX)
        parts.append(slice(start, int(places[-1]) + 1 + _MARGIN_PX))
    return parts[0], parts[1]


def _placed(
    part: Float32[np.ndarray, "part_h part_w"],
    cut: tuple[slice, slice],
    shape: tuple[int, int],
) -> _Soft:
    """Put a part back into the photo, with nothing round it."""
    result = np.zeros(shape, np.float32)
    result[cut] = part
    return result
