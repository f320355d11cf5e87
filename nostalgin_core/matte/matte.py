"""Each front gets a soft outline, and what stands before it is taken off.

The network's outlines are right to a few pixels; closed-form matting moves them to the
edges that the camera saw. Three kinds of boundary are told apart:

- all fronts together against the sky, the street or a wall: matted once, along their
  common amodal outline;
- a front against its neighbour: matted in a narrow seam, in which they share the pixel,
  so that alphas of neighbours add up to what the fronts have in common;
- a front against what hides it: all occluders are matted together, once.

    visible alpha = alpha of all fronts * this front's share * (1 - alpha of occluders)
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float32, Int

from nostalgin_core.arrays import Gray, Mask, Probability
from nostalgin_core.matte import closed_form, facade
from nostalgin_core.matte.laplacian import Belief
from nostalgin_core.matte.straight import straight
from nostalgin_core.matte.trimap import (
    BACKGROUND,
    FOREGROUND,
    UNKNOWN,
    Trimap,
    signed_distance,
    trimap,
)
from nostalgin_core.records import Facade, Instance, Matted, Occluder, Photo, Rejection

EPSILON: Final = 1e-5  # film grain has a standard deviation of 0.003 to 0.01
BELIEF: Final = 0.01  # in the network, where the image shows no edge
DIRECT: Final = 5_000  # unknowns; a belief leaves less for the full size to mend
_HIDDEN: Final = 0.95  # of a pixel: as good as wholly hidden
_FAR: Final = 1e6  # px: farther than any photo is wide
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
    found = fronts(photo, instances)
    if isinstance(found, Rejection):
        return found
    instances, facades = found
    built = [one for one in instances if one.category == "facade"]
    return softened(
        photo,
        instances,
        facades,
        highest(built, photo.image.shape),
        least=least,
        facade_px=facade_px,
        occluder_px=occluder_px,
        epsilon=epsilon,
        belief=belief,
    )


def softened(
    photo: Photo,
    instances: Sequence[Instance],
    facades: Sequence[Facade],
    likely: Probability,
    *,
    least: float,
    facade_px: tuple[float, float],
    occluder_px: tuple[float, float],
    epsilon: float,
    belief: float,
) -> Matted:
    """Give arranged fronts their soft visible membership, as `matte` has it.

    `likely` is how probably each pixel of the photo is of a front.
    """
    shape = photo.image.shape
    x0, y0, x1, y1 = photo.frame
    cut = np.s_[y0:y1, x0:x1]
    light = np.ascontiguousarray(photo.image[cut])
    solve = partial(soft, light, epsilon=epsilon, belief=belief)
    hiders = [i for i in instances if i.category != "facade"]
    wholes = [front.amodal[cut] for front in facades]
    built = np.any(wholes, axis=0)
    near = grown(built, facade_px[1])
    hidden = _hidden(solve, highest(hiders, shape)[cut], near, least, occluder_px)
    common = solve(*outline(built, likely[cut], hidden, px=facade_px))
    seen = common * (1.0 - hidden)
    alphas = _shared(solve, wholes, seen, facade_px)
    hiding = _placed(hidden, cut, shape)
    return Matted(
        tuple(
            replace(front, alpha=_placed(alpha, cut, shape))
            for front, alpha in zip(facades, alphas, strict=True)
        ),
        tuple(_occluder(i, hiding, least) for i in hiders),
    )


def fronts(
    photo: Photo, instances: Sequence[Instance]
) -> tuple[tuple[Instance, ...], tuple[Facade, ...]] | Rejection:
    """Give instances with straight sides, and the fronts they make, before matting."""
    straightened = straight(photo, instances)
    arranged = facade.arrange(photo, straightened)
    return arranged if isinstance(arranged, Rejection) else (straightened, arranged)


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
        image[part], known[part], prior=prior, epsilon=epsilon, direct=DIRECT
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
    if not mask.any():
        return mask.copy()
    away = cv2.distanceTransform((~mask).astype(np.uint8), cv2.DIST_L2, 5)
    return away <= distance_px + np.float32(0.5)


def _hidden(
    solve: _Solve, likely: _Soft, near: Mask, least: float, px: tuple[float, float]
) -> _Soft:
    """Matte all that hides fronts, where there are fronts to hide."""
    known = trimap(likely, least_px=px[0], most_px=px[1])
    sure = np.where(likely > least, FOREGROUND, BACKGROUND).astype(np.uint8)
    return solve(np.where(near, known, sure), likely)


def outline(
    whole: Mask, likely: _Soft, hidden: _Soft, *, px: tuple[float, float]
) -> tuple[Trimap, _Soft]:
    """Draw a trimap along an amodal outline, and mend the network's probability.

    The probability serves where it agrees with the outline. What is hidden anyway is
    not asked: the outline has the last word there.
    """
    agreed = np.where(whole, np.maximum(likely, 0.5), np.minimum(likely, 0.49))
    agreed = agreed.astype(np.float32)
    known = trimap(agreed, least_px=px[0], most_px=px[1])
    sure = np.where(whole, FOREGROUND, BACKGROUND).astype(np.uint8)
    return np.where(hidden < _HIDDEN, known, sure), agreed


def _shared(
    solve: _Solve, wholes: Sequence[Mask], seen: _Soft, px: tuple[float, float]
) -> list[_Soft]:
    """Share what is seen among the fronts: the nearest takes it, but for matted seams.

    Half the difference of two fronts' depths is the distance to the middle between
    them, wherever they touch, overlap or leave a gap. Fronts stand in a row, so every
    other one is told from those between, all seams in one go; where two of a kind meet,
    the middle parts them.
    """
    alphas = [np.zeros_like(seen) for _ in wholes]
    if not (seen > 0).any():
        return alphas
    seam_px, most_px = px
    # Nothing is seen beyond a front's band; a neighbour farther off shares no seam.
    near = [_around(one, round(most_px + 2 * seam_px) + _MARGIN_PX) for one in wholes]
    first, second, middle = _nearest(wholes, near)
    for i, (alpha, here) in enumerate(zip(alphas, near, strict=True)):
        np.multiply(seen[here], first[here] == i, out=alpha[here])
    odd = first % 2 == 1
    seam = (middle < seam_px) & ((first + second) % 2 == 1) & (seen > 1 - _HIDDEN)
    known = np.where(odd, np.uint8(FOREGROUND), np.uint8(BACKGROUND))
    known[seam] = UNKNOWN
    away = np.where(odd, middle, -middle) / np.float32(2 * seam_px)
    of_odd = solve(known, np.clip(away + np.float32(0.5), 0, 1))[seam]
    leads, follows, there = first[seam], second[seam], seen[seam]
    for i, alpha in enumerate(alphas):
        ours = of_odd if i % 2 else 1 - of_odd
        alpha[seam] = there * ours * ((leads == i) | (follows == i))
    return alphas


def _nearest(
    wholes: Sequence[Mask], near: Sequence[tuple[slice, slice]]
) -> tuple[Int[np.ndarray, "h w"], Int[np.ndarray, "h w"], _Soft]:
    """Tell which front is deepest at each pixel, which is next, and half by how much.

    A front is told of `near` it alone. Where none is, first or second is -1, infinitely
    far.
    """
    shape = wholes[0].shape
    first, second = np.full(shape, -1, np.int16), np.full(shape, -1, np.int16)
    deepest, deep = np.full(shape, -_FAR, np.float32), np.full(shape, -_FAR, np.float32)
    for i, (whole, here) in enumerate(zip(wholes, near, strict=True)):
        depth = signed_distance(whole[here]).clip(-_FAR / 2, _FAR / 2)
        leads = depth > deepest[here]
        np.copyto(second[here], i, where=depth > deep[here])
        np.copyto(second[here], first[here], where=leads)
        np.copyto(first[here], i, where=leads)
        np.maximum(deep[here], np.minimum(depth, deepest[here]), out=deep[here])
        np.maximum(deepest[here], depth, out=deepest[here])
    return first, second, (deepest - deep) / 2


def _occluder(instance: Instance, hidden: _Soft, least: float) -> Occluder:
    """Give an occluder its share of what was matted, within a little of its mask."""
    mask = np.zeros(hidden.shape, bool)
    x0, y0, x1, y1 = instance.box
    mask[y0:y1, x0:x1] = instance.probability > least
    reach = (
        slice(max(0, y0 - _MARGIN_PX), y1 + _MARGIN_PX),
        slice(max(0, x0 - _MARGIN_PX), x1 + _MARGIN_PX),
    )
    mask[reach] = grown(mask[reach], float(_MARGIN_PX)) & (hidden[reach] > 0.5)
    return Occluder(instance.category, instance.score, mask)


def _around(mask: Mask, margin_px: int = _MARGIN_PX) -> tuple[slice, slice]:
    """Cut out a mask's bounding box, with a margin, inside the image."""
    parts = []
    for axis in (1, 0):
        places = np.flatnonzero(mask.any(axis=axis))
        start = max(0, int(places[0]) - margin_px)
        parts.append(slice(start, int(places[-1]) + 1 + margin_px))
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
