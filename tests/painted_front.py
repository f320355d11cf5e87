"""A plane of windows photographed by a known camera: the truth of `rectify`'s tests."""

from dataclasses import dataclass

import cv2
import numpy as np

from nostalgin_core import homography
from nostalgin_core.records import Box, Facade, Matted, Photo
from nostalgin_core.rectify import camera, upright

SHAPE = (800, 600)


@dataclass(frozen=True)
class Painted:
    """A photo, perfect masks, and what a rectifier ought to find."""

    photo: Photo
    matted: Matted
    quads: list[np.ndarray]
    aspects: list[float]
    focal_px: float
    planes: list[np.ndarray]  # across, down and the top left corner, seen by the camera


def texture(aspect: float, rng: np.random.Generator, side: int = 700) -> np.ndarray:
    """Paint rows of windows with sills between cornices, at 1 / `aspect` high."""
    h, w = side, round(side * aspect)
    wall = np.full((h, w), 150, np.uint8)
    rows, columns = 7, max(2, round(7 * aspect))
    for r in range(rows):
        for c in range(columns):
            y0, x0 = round((r + 0.3) * h / rows), round((c + 0.3) * w / columns)
            y1, x1 = round((r + 0.8) * h / rows), round((c + 0.7) * w / columns)
            wall[y0:y1, x0:x1] = rng.integers(30, 80)
            wall[y1 : y1 + 4, x0 - 4 : x1 + 4] = 210
    wall[: h // 40], wall[-h // 40 :] = 90, 60
    return wall


def photograph(
    *,
    focal: float = 680.0,
    roll_deg: float = 1.0,
    tilt_deg: float = 12.0,
    azimuths_deg: tuple[float, ...] = (-35.0, 55.0),
    aspects: tuple[float, ...] = (0.8, 0.6),
    seed: int = 0,
) -> Painted:
    """Photograph one front, or two that meet at a corner, with grain and blur."""
    rng = np.random.default_rng(seed)
    h, w = SHAPE
    frame = Box(0, 0, w, h)
    parameters = np.array(
        [0.0, *np.radians([roll_deg, tilt_deg]), *np.radians(azimuths_deg)]
    )
    directions = upright.axes(parameters)
    photo_from_camera = camera.matrix(focal, frame)
    image = np.full((4 * h // 2, 4 * w // 2), 215, np.uint8)
    double = np.diag([2.0, 2.0, 1.0])
    double[:2, 2] = 0.5
    corner = np.array([0.0, -0.1, 3.6])
    height = 2.6
    quads, facades, planes = [], [], []
    start = corner if len(aspects) > 1 else corner - np.array([0.7, 0.0, 0.0])
    for i, aspect in enumerate(aspects):
        across, down = directions[1 + i] * height * aspect, -directions[0] * height
        left = start if i == len(aspects) - 1 else start - across
        top = left - 0.7 * down
        plane = photo_from_camera @ np.column_stack([across, down, top])
        unit = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        quad = homography.apply(plane, unit)
        wall = texture(aspect, rng)
        edges = unit * [wall.shape[1], wall.shape[0]] - 0.5
        to_image = double @ homography.between(edges, quad)
        size = (image.shape[1], image.shape[0])
        cv2.warpPerspective(
            wall, to_image, size, image, cv2.INTER_AREA, cv2.BORDER_TRANSPARENT
        )
        mask = np.zeros(SHAPE, np.uint8)
        cv2.fillConvexPoly(mask, np.rint(quad).astype(np.int32), 1)
        seen = mask > 0
        alpha = seen.astype(np.float32)
        facades.append(Facade(i, 1.0, i == 0, 1.0, seen, seen, alpha))
        quads.append(quad)
        planes.append(np.column_stack([across, down, top]))
    small = cv2.resize(image, (w, h), interpolation=cv2.INTER_AREA)
    grain = rng.normal(0, 3, SHAPE)
    noisy = np.clip(cv2.GaussianBlur(small, (0, 0), 0.6) + grain, 0, 255)
    photo = Photo(f"{seed:016x}", noisy.astype(np.uint8), frame)
    matted = Matted(tuple(facades), ())
    return Painted(photo, matted, quads, list(aspects), focal, planes)
