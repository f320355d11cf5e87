"""Fronts of rare shapes: one with a second side round its corner, one with a shop out.

Either wears the front's own texture, what hides it taken off, laid anew over a larger
outline. What the new outline covers of other fronts is taken from them; what stands
before fronts goes on standing before them.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import cv2
import numpy as np

from export.painted_segmentation_data import rings
from export.rare_kinds import focused, fronts, laid
from export.segmentation_data import Sample, Thing, fill
from nostalgin_core.arrays import Gray, Mask, Points
from nostalgin_core.measure.segmentation import overlap

LEAST_WIDE: Final = 0.1  # of the photo's width: narrower fronts hold no texture
LEAST_TALL: Final = 0.2  # of the photo's height
SQUARE: Final = 0.75  # overlap of a front with the quad that it is taken for
MOST_HIDDEN: Final = 0.3  # of the texture
EDGE: Final = 0.1  # of a front's columns, where its sides are measured
BEYOND: Final = np.array([-1.0, 1.0]) * EDGE / (1 - 2 * EDGE)  # from there to its sides


def cornered(sample: Sample, rng: np.random.Generator) -> Sample:
    """Give a front a second one round its corner, seen along it at a grazing angle.

    Both are fronts of one building. Roof and foot of the second run towards a horizon
    at the height of a standing camera.
    """
    width = sample.image.shape[1]
    for front, quad in _large(sample, rng):
        right = rng.random() < 0.5
        roof, ground = (quad[1], quad[2]) if right else (quad[0], quad[3])
        room = width - 1 - roof[0] if right else roof[0]
        wide = min(rng.uniform(0.06, 0.22) * width, room)
        texture = _texture(sample, quad)
        if texture is None or wide < 0.04 * width:
            continue
        eye = ground[1] - rng.uniform(0.05, 0.15) * (ground[1] - roof[1])
        shrunk = rng.uniform(0.5, 0.85)
        far = roof[0] + (wide if right else -wide)
        ends = [(far, eye + shrunk * (y - eye)) for y in (roof[1], ground[1])]
        wing = np.array([roof, *ends, ground])
        lit = np.clip(texture * rng.uniform(0.5, 1.2), 0, 255).astype(np.uint8)
        side = Thing("facade", (wing,), 0, target=front.target)
        there = fill(side.rings, sample.image.shape)
        return _built(sample, there, _worn(lit, wing, sample.image.shape), side)
    return sample


def projecting(sample: Sample, rng: np.random.Generator) -> Sample:
    """Let a front's ground floor stand out of the wall above, under a ledge."""
    height, width = sample.image.shape
    for front, quad in _large(sample, rng):
        share = rng.uniform(0.15, 0.35)
        sills = quad[2:] + share * (quad[1::-1] - quad[2:])  # right, left
        texture = _texture(sample, np.array([sills[1], sills[0], quad[2], quad[3]]))
        if texture is None:
            continue
        out = rng.uniform(0.03, 0.12, 2) * (quad[1, 0] - quad[0, 0])
        tall = quad[2, 1] - quad[1, 1]
        rise, drop = rng.uniform((0.02, 0.0), (0.08, 0.04)) * tall
        grown = [(-out[0], -rise), (out[1], -rise), (out[1], drop), (-out[0], drop)]
        shop = np.array([sills[1], sills[0], quad[2], quad[3]]) + grown
        shop = np.clip(shop, 0, (width - 1, height - 1))
        ledge = np.array([shop[0], shop[1], shop[1], shop[0]])
        ledge[2:, 1] += max(2.0, 0.4 * rise)
        there = fill((shop,), sample.image.shape)
        worn = _worn(texture, shop, sample.image.shape)
        tone = rng.choice([rng.uniform(30, 90), rng.uniform(150, 220)])
        worn[fill((ledge,), sample.image.shape)] = round(float(tone))
        whole = replace(front, rings=rings(there | _inside(sample, front)))
        others = tuple(t for t in sample.things if t is not front)
        return _built(replace(sample, things=others), there, focused(worn), whole)
    return sample


def _large(sample: Sample, rng: np.random.Generator) -> Iterator[tuple[Thing, Points]]:
    """Yield fronts that are large quads, in any order, with their corners."""
    every = fronts(sample)
    for i in rng.permutation(len(every)):
        quad = _corners(_inside(sample, every[i]))
        if quad is not None:
            yield every[i], quad


def _corners(inside: Mask) -> Points | None:
    """Return a front's corners, clockwise from the top left; None if it has no four.

    Roof and foot are straight lines through what is seen of them near either side.
    """
    height, width = inside.shape
    columns = np.flatnonzero(inside.any(0))
    if len(columns) < LEAST_WIDE * width:
        return None
    x0, x1 = columns[[0, -1]]
    near = [round(x0 + share * (x1 - x0)) for share in (EDGE, 1 - EDGE)]
    if not inside[:, near].any(0).all():
        return None
    tops = np.argmax(inside[:, near], axis=0)
    feet = height - 1 - np.argmax(inside[::-1, near], axis=0)
    roof, ground = (y + (y[1] - y[0]) * BEYOND for y in (tops, feet))
    quad = np.array([(x0, roof[0]), (x1, roof[1]), (x1, ground[1]), (x0, ground[0])])
    quad = quad.astype(float)
    square = overlap(fill((quad,), inside.shape), inside) >= SQUARE
    tall = min(quad[3, 1] - quad[0, 1], quad[2, 1] - quad[1, 1])
    return quad if square and tall >= LEAST_TALL * height else None


def _inside(sample: Sample, thing: Thing) -> Mask:
    return fill(thing.rings, sample.image.shape)


def _texture(sample: Sample, quad: Points) -> Gray | None:
    """Return a quad straightened, without what hides it; None where too much does."""
    width, height = (round(float(side)) for side in np.ptp(quad, axis=0))
    corners = _rectangle(width, height)
    texture_from_photo = cv2.getPerspectiveTransform(quad.astype(np.float32), corners)
    size = width, height
    shown, hidden = (
        cv2.warpPerspective(
            picture, texture_from_photo, size, borderMode=cv2.BORDER_REPLICATE
        )
        for picture in (sample.image, _hidden(sample).astype(np.uint8))
    )
    if hidden.mean() > MOST_HIDDEN:
        return None
    return cv2.inpaint(shown, hidden, 3, cv2.INPAINT_NS).astype(np.uint8)


def _hidden(sample: Sample) -> Mask:
    shape = sample.image.shape
    before = [fill(t.rings, shape) for t in sample.things if t.layer]
    return np.any([np.zeros(shape, bool), *before], axis=0)


def _rectangle(width: int, height: int) -> np.ndarray:
    corners = np.array([(0, 0), (width, 0), (width, height), (0, height)]) - 0.5
    return corners.astype(np.float32)


def _worn(texture: Gray, quad: Points, shape: tuple[int, int]) -> Gray:
    """Lay a texture over a quad, its corners clockwise from the top left."""
    corners = _rectangle(*texture.shape[::-1])
    photo_from_texture = cv2.getPerspectiveTransform(corners, quad.astype(np.float32))
    return cv2.warpPerspective(
        texture, photo_from_texture, shape[::-1], borderMode=cv2.BORDER_REPLICATE
    ).astype(np.uint8)


def _built(sample: Sample, there: Mask, worn: Gray, front: Thing) -> Sample:
    """Put a front where it is painted, before all others and behind what hides."""
    image = laid(sample.image, there & ~_hidden(sample), worn)
    things = [_less(thing, there) for thing in sample.things]
    return Sample(sample.name, image, (*(t for t in things if t.rings), front))


def _less(thing: Thing, there: Mask) -> Thing:
    """Take from a front what another now covers."""
    if thing.layer:
        return thing
    inside = fill(thing.rings, there.shape)
    if not (inside & there).any():
        return thing
    return replace(thing, rings=rings(inside & ~there))
