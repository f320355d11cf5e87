"""All that is exactly known of a painted photo."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8

from nostalgin_core.arrays import Alpha, Corners, Gray, Homogeneous, Mask, Matrix3
from nostalgin_core.records import Box, Category
from nostalgin_core.scenes.lens import Camera


@dataclass(frozen=True, slots=True, eq=False)
class TrueFacade:
    """One front as the photo shows it. Masks have the size of the photo."""

    front_id: str  # block-lot-side
    target: bool
    visible: Mask
    amodal: Mask  # visible, plus what people, cars, signs and the like cover
    alpha: Alpha  # share of each pixel's light that comes from this front
    quad: Corners  # tl, tr, br, bl in photo pixels, possibly outside the photo
    vanishing_points: Homogeneous  # horizontal, then vertical; photo pixels
    aspect: float  # width / height
    width_m: float
    height_m: float
    texture: UInt8[np.ndarray, "y x"]  # the clean front, as an architect would draw it
    m_per_px: float  # of the texture
    photo_from_texture: Matrix3
    complete: bool  # wholly inside the frame


@dataclass(frozen=True, slots=True, eq=False)
class TrueOccluder:
    """Something that hides fronts. Its mask is what is seen of it."""

    category: Category
    mask: Mask
    alpha: Alpha


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """What the painter knows: camera, fronts from left to right, occluders."""

    camera: Camera
    facades: tuple[TrueFacade, ...]
    occluders: tuple[TrueOccluder, ...]  # near ones first
    rest: Alpha  # share of each pixel's light from sky, ground, walls, film border
    placard_text: str  # as on the board, e.g. "2001 -7 M"; empty where there is none
    frame: Box


@dataclass(frozen=True, slots=True, eq=False)
class PaintedPhoto:
    """A photo and its truth."""

    name: str  # file name without suffix
    image: Gray
    truth: Truth
