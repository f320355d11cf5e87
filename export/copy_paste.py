"""People, cars, boards and posts cut out of some photographs stand in others.

Ghiasi et al., "Simple Copy-Paste is a Strong Data Augmentation", CVPR 2021. What is
pasted keeps its height above the ground and about its size, since street photographs
were taken from much the same distance by standing photographers.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from export.segmentation_data import Sample, Thing, fill
from nostalgin_core.arrays import Gray, Points
from nostalgin_core.records import Category

SMALLEST_DONOR_PX = 16
MARGIN_PX = 3


@dataclass(frozen=True, slots=True, eq=False)
class Donor:
    """Something cut out of a photograph, with a little of what surrounds it."""

    category: Category
    patch: Gray
    rings: tuple[Points, ...]  # in pixels of the patch
    foot: float  # height of its lowest pixel in its photo, 0 at the top, 1 below
    photo_height: int


def donors(samples: Sequence[Sample]) -> list[Donor]:
    """Cut out what hides fronts and is large enough to be told what it is."""
    cut = []
    for sample in samples:
        height, width = sample.image.shape
        for thing in sample.things:
            if thing.category == "facade":
                continue
            points = np.concatenate(thing.rings)
            low = np.floor(points.min(0)).astype(int) - MARGIN_PX
            high = np.ceil(points.max(0)).astype(int) + MARGIN_PX
            x0, y0 = np.maximum(low, 0)
            x1, y1 = np.minimum(high, (width, height))
            if min(x1 - x0, y1 - y0) < SMALLEST_DONOR_PX:
                continue
            patch = sample.image[y0:y1, x0:x1].copy()
            foot = float(points[:, 1].max() / height)
            rings = tuple(ring - (x0, y0) for ring in thing.rings)
            cut.append(Donor(thing.category, patch, rings, foot, height))
    return cut


def paste(
    sample: Sample, cut: Sequence[Donor], rng: np.random.Generator, *, most: int = 4
) -> Sample:
    """Stand up to `most` donors in a sample, the later before the earlier."""
    image, things = sample.image.copy(), list(sample.things)
    layer = max((t.layer for t in things), default=0)
    for donor in rng.permutation(len(cut))[: int(rng.integers(most + 1))]:
        layer += 1
        thing = _stand(image, cut[donor], layer, rng)
        if thing is not None:
            things.append(thing)
    return Sample(sample.name, image, tuple(things))


def _stand(
    image: Gray, donor: Donor, layer: int, rng: np.random.Generator
) -> Thing | None:
    """Draw a donor into the image at a place where it could be standing."""
    height, width = image.shape
    scale = height / donor.photo_height * np.exp(rng.uniform(-0.4, 0.4))
    size = [max(2, round(s * scale)) for s in donor.patch.shape[::-1]]
    if size[0] >= width or size[1] >= height:
        return None
    patch = cv2.resize(donor.patch, size, interpolation=cv2.INTER_AREA)
    enlarged = np.array(size) / donor.patch.shape[::-1]
    rings = tuple(ring * enlarged for ring in donor.rings)
    if rng.random() < 0.5 and donor.category != "placard":  # boards are not mirrored
        patch = patch[:, ::-1]
        rings = tuple(ring * (-1, 1) + (size[0] - 1, 0) for ring in rings)
    foot = (donor.foot + rng.normal(0, 0.03)) * height
    y0 = int(np.clip(foot - size[1], 0, height - size[1]))
    x0 = int(rng.integers(width - size[0]))
    inside = fill(rings, patch.shape).astype(np.float32)
    soft = cv2.GaussianBlur(inside, (0, 0), 0.7) * inside
    there = image[y0 : y0 + size[1], x0 : x0 + size[0]]
    shade = rng.uniform(0.8, 1.2)
    blended = soft * np.clip(patch * shade, 0, 255) + (1 - soft) * there
    there[:] = np.round(blended).astype(np.uint8)
    rings = tuple(ring + np.array([x0, y0]) for ring in rings)
    return Thing(donor.category, rings, layer)
