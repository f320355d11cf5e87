"""What rises behind fronts, hangs before them, veils them or squeezes them together.

A bare wall rises where nothing is labelled, a slab or a girder is a thing of the class
other that lies before all else, haze hides nothing, and squeezing moves outlines along.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float

from export.segmentation_data import Sample, Thing, fill
from nostalgin_core.arrays import Gray, Mask, Points

LEAST_ABOVE: Final = 0.12  # of the photo's height that must be free above a low front
WHITE: Final = 235.0  # of haze, which is a sky's tone
SOFT_PX: Final = 0.8  # a lens's blur of an edge
LETTERS: Final = "ABCDEFGHIKLMNOPRSTUVWY "


def walled(sample: Sample, rng: np.random.Generator) -> Sample:
    """Raise a blank wall behind a low front: it ends where roofs begin."""
    height, width = sample.image.shape
    low = [t for t in fronts(sample) if top(t) > LEAST_ABOVE * height]
    if not low:
        return sample
    front = low[int(rng.integers(len(low)))]
    x0, x1 = np.clip(reach(front), 0, width - 1)
    x0, x1 = (x0, x1) + (x1 - x0) * rng.uniform(-0.2, 0.2, 2)
    y0 = rng.uniform(0.0, 0.6) * top(front)
    lean = rng.uniform(-0.05, 0.05) * height
    corners = [(x0, y0), (x1, y0 + lean), (x1, height), (x0, height)]
    wall = fill([np.array(corners)], sample.image.shape) & _sky(sample)
    return replace(sample, image=laid(sample.image, wall, _bare(wall, rng)))


def marquee(sample: Sample, rng: np.random.Generator) -> Sample:
    """Hang a lettered slab before a front, between its middle and its doors."""
    height, width = sample.image.shape
    behind = fronts(sample)
    if not behind:
        return sample
    front = behind[int(rng.integers(len(behind)))]
    x0, x1 = np.clip(reach(front), 0, width - 1)
    y0, y1 = np.clip((top(front), foot(front)), 0, height - 1)
    half = rng.uniform(0.2, 0.55) * (x1 - x0)
    middle = rng.uniform(0.3, 0.7) * (x1 - x0) + x0
    upper = y0 + rng.uniform(0.5, 0.8) * (y1 - y0)
    tall = rng.uniform(0.04, 0.1) * height
    lean = rng.uniform(-0.3, 0.3) * tall
    left, right = np.clip((middle - half, middle + half), 0, width - 1)
    slab = _band(left, right, upper, upper + lean, tall)
    return _hung(sample, (slab,), _fascia(slab, sample.image.shape, rng))


def railway(sample: Sample, rng: np.random.Generator) -> Sample:
    """Lay a lattice girder on posts across the whole street."""
    height, width = sample.image.shape
    upper, tall = rng.uniform(0.3, 0.6) * height, rng.uniform(0.05, 0.14) * height
    lean = rng.uniform(-0.08, 0.08) * height
    rings = [_band(0, width - 1, upper, upper + lean, tall)]
    for middle in rng.uniform(0, width, int(rng.integers(1, 4))):
        half = rng.uniform(0.006, 0.02) * width
        left, right = np.clip((middle - half, middle + half), 0, width - 1)
        under = upper + tall + lean * middle / width - 1  # no slit below the girder
        ground = rng.uniform(0.8, 1.0) * height
        rings.append(_band(left, right, under, under, ground - under))
    return _hung(sample, tuple(rings), _lattice(sample.image.shape, rng))


def hazy(sample: Sample, rng: np.random.Generator) -> Sample:
    """Let what stands high, and so far, fade into the sky."""
    height = sample.image.shape[0]
    line = rng.uniform(0.2, 0.6) * height
    share = np.clip((line - np.arange(height)) / (0.3 * height), 0, 1)
    veil = (rng.uniform(0.3, 0.75) * share)[:, None]
    image = sample.image * (1 - veil) + WHITE * veil
    return replace(sample, image=np.round(image).astype(np.uint8))


def grazing(sample: Sample, rng: np.random.Generator) -> Sample:
    """Squeeze a photograph from the sides, and put it beside its own mirror."""
    height, width = sample.image.shape
    narrow = int(np.ceil(width * rng.uniform(0.5, 0.75)))
    size = narrow, height
    image = cv2.resize(sample.image, size, interpolation=cv2.INTER_AREA)
    whole = np.hstack([image, image[:, ::-1][:, : width - narrow]]).astype(np.uint8)
    squeezed, half = narrow / width, np.array([0.5, 0.0])
    first, second = [], []
    for thing in sample.things:
        rings = [(ring + half) * (squeezed, 1) - half for ring in thing.rings]
        rings = [_left_of(ring, narrow - 1) for ring in rings]
        mirrored = [ring * (-1, 1) + (2 * narrow - 1, 0) for ring in rings]
        mirrored = [_left_of(ring, width - 1) for ring in mirrored]
        first += _of(thing, rings)
        second += _of(replace(thing, target=False), mirrored)
    return Sample(sample.name, whole, (*first, *second))


def _left_of(ring: Points, x: float) -> Points:
    """Return what of a ring lies at most at x (Sutherland and Hodgman, 1974)."""
    ahead = np.roll(ring, -1, axis=0)
    before, after = ring[:, 0] - x, ahead[:, 0] - x
    crossing = before * after < 0
    run = np.where(crossing, after - before, 1.0)
    met = ring - (ahead - ring) * (before / run)[:, None]
    both = np.stack([ring, met], axis=1).reshape(-1, 2)
    return both[np.stack([before <= 0, crossing], axis=1).ravel()]


def _of(thing: Thing, rings: Sequence[Points]) -> list[Thing]:
    left = tuple(ring for ring in rings if len(ring) > 2 and np.ptp(ring[:, 0]) > 1)
    return [replace(thing, rings=left)] if left else []


def fronts(sample: Sample) -> list[Thing]:
    """Return the fronts that are told apart and stand inside the frame."""
    height, width = sample.image.shape
    fronts = [t for t in sample.things if t.category == "facade" and t.scored]
    seen = (fill(t.rings, (height, width)).any() for t in fronts)
    return [t for t, one in zip(fronts, seen, strict=True) if one]


def top(thing: Thing) -> float:
    """Return the height of a thing's highest point, in pixels from above."""
    return float(np.concatenate(thing.rings)[:, 1].min())


def foot(thing: Thing) -> float:
    """Return the height of a thing's lowest point, in pixels from above."""
    return float(np.concatenate(thing.rings)[:, 1].max())


def reach(thing: Thing) -> tuple[float, float]:
    """Return a thing's leftmost and rightmost x."""
    xs = np.concatenate(thing.rings)[:, 0]
    return float(xs.min()), float(xs.max())


def _band(
    left: float, right: float, top: float, top_right: float, tall: float
) -> Points:
    """Return an upright quad whose upper and lower edges lean alike."""
    upper = [(left, top), (right, top_right)]
    lower = [(right, top_right + tall), (left, top + tall)]
    return np.array(upper + lower, float)


def _sky(sample: Sample) -> Mask:
    """Return what lies above the fronts of its column and is no labelled thing."""
    shape = sample.image.shape
    built, taken = np.zeros(shape, bool), np.zeros(shape, bool)
    for thing in sample.things:
        inside = fill(thing.rings, shape)
        taken |= inside
        if thing.category == "facade":
            built |= inside
    return ~np.logical_or.accumulate(built, axis=0) & built.any(0) & ~taken


def _bare(wall: Mask, rng: np.random.Generator) -> Gray:
    """Paint bricks with neither windows nor cornices, under a coping."""
    tone = rng.uniform(60, 190)
    coarse = rng.normal(0, 12, (5, 4)).astype(np.float32)
    stains = cv2.resize(coarse, wall.shape[::-1], interpolation=cv2.INTER_CUBIC)
    courses = rng.normal(0, 3, (wall.shape[0], 1))
    bricks = tone + stains + courses + rng.normal(0, 4, wall.shape)
    coping = wall & ~np.roll(wall, max(2, wall.shape[0] // 150), axis=0)
    bricks += coping * rng.uniform(-40, 40)
    return focused(bricks)


def _lattice(shape: tuple[int, int], rng: np.random.Generator) -> Gray:
    """Paint iron bars that cross."""
    ys, xs = np.indices(shape)
    turns = 2 * np.pi / rng.uniform(6, 30)
    bars = np.maximum(np.sin((xs + ys) * turns), np.sin((xs - ys) * turns))
    tone = rng.uniform(20, 90) if rng.random() < 0.7 else rng.uniform(130, 200)
    return focused(tone + bars * rng.uniform(0, 25) + rng.normal(0, 5, shape))


def _fascia(slab: Points, shape: tuple[int, int], rng: np.random.Generator) -> Gray:
    """Paint a board with a line of letters, light on dark or dark on light."""
    tone, ink = rng.permutation([rng.uniform(20, 90), rng.uniform(160, 235)])
    board = np.full(shape, round(tone), np.uint8)
    text = "".join(rng.choice(list(LETTERS), int(rng.integers(5, 14))))
    (left, top), (right, bottom) = slab.min(0), slab.max(0)
    face = cv2.FONT_HERSHEY_DUPLEX
    (wide, tall), _ = cv2.getTextSize(text, face, 1.0, 1)
    size = min(0.9 * (right - left) / wide, 0.5 * (bottom - top) / tall)
    at = (
        round((left + right - size * wide) / 2),
        round((top + bottom + size * tall) / 2),
    )
    cv2.putText(board, text, at, face, size, float(ink), 1, cv2.LINE_AA)
    return focused(board + rng.normal(0, 4, shape))


def focused(tones: Float[np.ndarray, "h w"]) -> Gray:
    """Blur tones as a lens does, and make gray pixels of them."""
    soft = cv2.GaussianBlur(tones.astype(np.float32), (0, 0), SOFT_PX)
    return np.clip(np.round(soft), 0, 255).astype(np.uint8)


def laid(image: Gray, where: Mask, what: Gray) -> Gray:
    """Put one picture over another where a mask says, with a soft edge."""
    share = cv2.GaussianBlur(where.astype(np.float32), (0, 0), SOFT_PX)
    return np.round(image * (1 - share) + what * share).astype(np.uint8)


def _hung(sample: Sample, rings: tuple[Points, ...], what: Gray) -> Sample:
    """Put things of the class other before all else."""
    shape = sample.image.shape
    where = np.any([fill((ring,), shape) for ring in rings], axis=0)
    layer = max((t.layer for t in sample.things), default=0) + 1
    things = (*sample.things, *(Thing("other", (ring,), layer) for ring in rings))
    return Sample(sample.name, laid(sample.image, where, what), things)
