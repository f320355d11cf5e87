"""What archives did to photographs: holes punched, letters laid over, light let in.

A hole and a flare hide what they cover, so that they become things to be found (class
*other*); letters laid over a whole photo hide nothing and are to be looked through.
"""

import cv2
import numpy as np

from export.segmentation_data import Sample, Thing
from nostalgin_core.arrays import Gray, Points

CORNERS = 32  # of a circle's outline
BLOWN_OUT = 0.85  # of a flare's strength: what is lost inside its outline
LETTERS = "ABCDEFGHIKLMNOPRSTUVWY0123456789 "


def blemished(sample: Sample, rng: np.random.Generator) -> Sample:
    """Give a sample, now and then, a punched hole, a flare, or letters all over."""
    image, things = sample.image.copy(), list(sample.things)
    layer = max((t.layer for t in things), default=0) + 1
    for chance, spoil in ((0.1, _punch), (0.08, _flare)):
        if rng.random() < chance:
            things.append(Thing("other", (spoil(image, rng),), layer))
    if rng.random() < 0.15:
        image = lettered(image, rng)
    return Sample(sample.name, image, tuple(things))


def _circle(centre: np.ndarray, radii: np.ndarray) -> Points:
    turn = np.arange(CORNERS) * (2 * np.pi / CORNERS)
    return centre + radii * np.stack([np.cos(turn), np.sin(turn)], axis=1)


def _punch(image: Gray, rng: np.random.Generator) -> Points:
    """Punch a round hole through which the scanner's black or white shows."""
    height, width = image.shape
    centre = rng.uniform(0, 1, 2) * (width, height)
    radius = rng.uniform(0.012, 0.08) * width
    tone = float(rng.choice([rng.uniform(0, 25), rng.uniform(230, 255)]))
    ring = _circle(centre, np.array([radius, radius]))
    cv2.fillPoly(image, [np.round(ring * 16).astype(np.int32)], tone, cv2.LINE_AA, 4)
    return ring


def _flare(image: Gray, rng: np.random.Generator) -> Points:
    """Let light in: a white core within a halo that fades; the core is what is lost."""
    height, width = image.shape
    centre = rng.uniform(0, 1, 2) * (width, height)
    spread = rng.uniform(0.03, 0.12, 2) * width
    ys, xs = np.mgrid[:height, :width].astype(np.float32)
    away = ((xs - centre[0]) / spread[0]) ** 2 + ((ys - centre[1]) / spread[1]) ** 2
    strength = rng.uniform(1.2, 2.5)
    light = np.minimum(1, strength * np.exp(-away / 2))
    image[:] = np.round(image + (255 - image) * light).astype(np.uint8)
    core = np.sqrt(2 * np.log(strength / BLOWN_OUT))
    return _circle(centre, core * spread)


def lettered(image: Gray, rng: np.random.Generator) -> Gray:
    """Lay letters over a photo, lighter or darker, aslant as watermarks are."""
    height, width = image.shape
    canvas = np.zeros(image.shape, np.uint8)
    size = rng.uniform(0.8, 3.5) * width / 400
    thick = max(1, round(size * rng.uniform(1.5, 5)))
    step = int(size * rng.uniform(30, 90))
    for y in range(step // 2, height + step, step):
        text = "".join(rng.choice(list(LETTERS), int(rng.integers(4, 24))))
        at = int(rng.uniform(-0.2, 0.5) * width), y
        cv2.putText(canvas, text, at, cv2.FONT_HERSHEY_SIMPLEX, size, 255, thick)
    turned = cv2.getRotationMatrix2D(
        (width / 2, height / 2), float(rng.uniform(-45, 45)), 1.0
    )
    canvas = cv2.warpAffine(canvas, turned, (width, height))
    tone = float(rng.choice([-1, 1]) * rng.uniform(6, 45))
    return np.clip(image + tone * (canvas / 255), 0, 255).astype(np.uint8)
