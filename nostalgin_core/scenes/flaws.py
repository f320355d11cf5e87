"""What keeps a real photograph from the drawing: uneven masonry, and a bending lens.

Nothing of a real front is quite where the architect drew it. Measured on photographs, a
line's direction is off by about as many degrees the shorter the line: the ends of long
cornices and of short sills stray by the same few millimetres. So a point of a front
strays by a sum of smooth random fields with the same deviation at every scale. The
front's plane and its two directions stay what they are: the truth is the drawing's.

A simple lens bends straight lines. A point that a pinhole would show at `p` from the
middle, in half diagonals, is shown at `q`, where p = q (1 + k |q|^2); k > 0 is a barrel
(Brown's first radial term, written from the picture's side). Beyond the picture's
corners, where there is nothing to see, it is taken to stretch as much as there.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Points
from nostalgin_core.scenes.style import FrontStyle
from nostalgin_core.scenes.surface import Canvas

SCALES_M = (0.5, 1.5, 4.5, 13.5)  # from a sill to a whole front
GROWTH = 0.35  # straying grows with its scale to this power
CELL_M = 0.125  # of the grid on which straying is given
ROUNDS = 12  # of the lens's inversion; 5 settle within a frame

Stray = Float[np.ndarray, "2 y x"]


@dataclass(frozen=True, slots=True)
class Flaws:
    """How uneven fronts are, and how much the lens bends; without any by default."""

    stray_m: float = 0.0  # one standard deviation at each scale, along and up
    barrel: float = 0.0  # k


def stray(style: FrontStyle, sd_m: float) -> Stray:
    """Tell by how far each place of a front strays, along and up, in front's units.

    Rows run upwards from the foot. The same front strays alike in every photo.
    """
    rng = np.random.default_rng([style.seed, 78, style.wing])
    size = np.array([style.height_m, style.width_m])
    h, w = np.maximum(np.ceil(size / CELL_M), 2).astype(int)
    field = np.zeros((2, h, w))
    for scale in SCALES_M:
        rows, columns = np.ceil(size / scale).astype(int) + 1
        for k in range(2):
            rough = rng.normal(0.0, sd_m * scale**GROWTH, (rows, columns))
            field[k] += cv2.resize(
                rough, (int(w), int(h)), interpolation=cv2.INTER_CUBIC
            )
    return field / size[::-1, None, None]


def bend(canvas: Canvas, k: float) -> Canvas:
    """See a canvas through a lens that bends by `k`."""
    h, w = canvas.tone.shape
    y, x = np.mgrid[0:h, 0:w].astype(np.float32)
    seen = np.stack([x.ravel(), y.ravel()], axis=1).astype(np.float64)
    true = pinhole(seen, (h, w), k).astype(np.float32).reshape(h, w, 2)

    def moved(plane: np.ndarray, how: int) -> np.ndarray:
        return cv2.remap(plane, true, None, how, borderMode=cv2.BORDER_REPLICATE)  # pyright: ignore[reportCallIssue, reportArgumentType]

    return Canvas(
        moved(canvas.tone, cv2.INTER_LINEAR),
        moved(canvas.nearness, cv2.INTER_NEAREST),
        moved(canvas.label, cv2.INTER_NEAREST),
    )


def bent(points: Points, shape: tuple[int, int], k: float) -> Points:
    """Move pinhole's points to where a lens that bends by `k` shows them."""
    middle = (np.array(shape[::-1]) - 1) / 2
    shown = points.copy()
    for _ in range(ROUNDS):
        stretch = _stretch(shown - middle, shape, k)
        shown = middle + (points - middle) / stretch
    return shown


def pinhole(shown: Points, shape: tuple[int, int], k: float) -> Points:
    """Move points of the picture to where a pinhole would show them."""
    middle = (np.array(shape[::-1]) - 1) / 2
    return middle + (shown - middle) * _stretch(shown - middle, shape, k)


def _stretch(off: Points, shape: tuple[int, int], k: float) -> Float[np.ndarray, "n 1"]:
    """Give 1 + k |q|^2, and 1 + k beyond the corners."""
    half = np.hypot(*shape) / 2
    square = (off**2).sum(axis=1, keepdims=True) / half**2
    return 1 + k * np.minimum(square, 1.0)
