"""Which stretch of its street a facade takes up, as its own photograph tells it.

Fronts of one street stand in one plane, and one camera sees them all. A standpoint is
told in widths of one front: (x, y, z) to the right, up and out from its lower left
corner. So a front reaches from -x / z to (1 - x) / z along the street, in distances of
the camera from that plane, which are the same for all its fronts, and unknown.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from nostalgin_core.records import Seen, Standpoint, Texture

EDGE: Final = 0.03  # of a photo's width: film borders are narrower


@dataclass(frozen=True, slots=True)
class Stretch:
    """What a facade takes up of its street, and what its photograph makes of it."""

    photo: str
    facade: int
    left: float  # from the foot of the camera, in its distances from the plane
    right: float
    heading_deg: float  # of the plane, from the camera's axis: more to the right
    left_px: float  # centre in the photo
    target_score: float
    score: float
    cut: bool = False  # by the left or right edge of the photo: it is wider than that

    @property
    def texture(self) -> Texture:
        """Name the facade as walls do."""
        return self.photo, self.facade

    @property
    def width(self) -> float:
        """Tell its width, in distances of the camera."""
        return self.right - self.left


def stretch(seen: Seen, stood: Standpoint) -> Stretch:
    """Sum up where a facade stands on its street."""
    x, _, z = stood.position
    far = max(abs(z), np.finfo(np.float64).eps)
    rotation = stood.front_from_camera
    return Stretch(
        photo=seen.photo,
        facade=seen.facade,
        left=-x / far,
        right=(1 - x) / far,
        heading_deg=float(np.degrees(np.arctan2(rotation[0, 2], -rotation[2, 2]))),
        left_px=seen.left_px,
        target_score=seen.target_score,
        score=seen.score,
        cut=cut(stood),
    )


def cut(stood: Standpoint) -> bool:
    """Tell whether a facade ends where its photo does, to the left or right."""
    wide, _ = stood.size_px
    x_px = stood.quad_px[:, 0]
    return bool(x_px.min() < EDGE * wide or x_px.max() > (1 - EDGE) * wide)
