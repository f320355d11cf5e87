"""The things that flow through the pipeline, from photograph to city block.

Every record is frozen. Those that carry arrays are compared by identity, since arrays
have no single truth value; everything else is compared by value. Keys are strings made
from content, so that running a stage twice writes the same rows.

Arrays of one record that share `h w` share a size. The tests check this on every
construction.
"""

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import (
    Alpha,
    Corners,
    EvidenceMap,
    Gray,
    Homogeneous,
    Mask,
    Matrix3,
    Points,
    Probability,
    Triangles,
)

Category = Literal["facade", "person", "vehicle", "placard", "vegetation", "other"]


class Box(NamedTuple):
    """A half-open rectangle of whole pixels."""

    x0: int
    y0: int
    x1: int
    y1: int


@dataclass(frozen=True, slots=True)
class Rejection:
    """Why one element went no further.

    It is always false, so that `if not result` reads well. `reason` is a short fixed
    phrase that can be counted; `detail` names the values and the remedy.
    """

    key: str
    stage: str
    reason: str
    detail: str = ""
    facade: int | None = None

    def __bool__(self) -> bool:
        """Count as nothing made."""
        return False


@dataclass(frozen=True, slots=True, eq=False)
class Photo:
    """One historical photograph, decoded, gray and upright."""

    key: str  # the first 16 hex digits of the file's SHA-256
    image: Gray
    frame: Box  # the exposed frame: what lies outside is film border, or paper
    sheet: Box | None = None  # a print with the light paper round it, if it has any


@dataclass(frozen=True, slots=True, eq=False)
class Instance:
    """One thing that the segmentation network found in a photo."""

    category: Category
    score: float
    box: Box  # in photo pixels, inside the photo
    probability: Probability  # the size of the box


@dataclass(frozen=True, slots=True, eq=False)
class Occluder:
    """Something that hides fronts, with its matted outline."""

    category: Category
    score: float
    mask: Mask  # the size of the photo


@dataclass(frozen=True, slots=True, eq=False)
class Facade:
    """One building front in one photo. All masks have the size of the photo."""

    index: int  # rank from left to right in the photo
    score: float
    target: bool  # the photo is a record of this facade's building
    target_score: float  # 0 to 1
    mask: Mask  # what the network calls visible, before matting
    amodal: Mask  # visible, plus what occluders cover
    alpha: Alpha  # soft membership after matting, occluders taken off


@dataclass(frozen=True, slots=True, eq=False)
class Matted:
    """What the matting stage knows of one photo."""

    facades: tuple[Facade, ...]  # from left to right
    occluders: tuple[Occluder, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """What somebody drew on a photo of the front that it is a record of."""

    outline: Points | None  # of the whole front, what stands before it included
    quad: Corners | None  # tl, tr, br, bl


@dataclass(frozen=True, slots=True, eq=False)
class Elevation:
    """A facade seen straight on, with right aspect, at the source's resolution."""

    facade: int  # the facade's index in its photo
    image: Gray
    alpha: Alpha  # visible facade, warped
    evidence: EvidenceMap
    quad: Corners  # tl, tr, br, bl in photo pixels
    photo_from_elevation: Matrix3
    vanishing_points: Homogeneous  # horizontal, then vertical: A times unit vectors
    focal_px: float | None  # None where the view does not tell it
    aspect: float  # width / height
    vanishing_sd_deg: tuple[float, float]  # horizontal, vertical
    focal_sd_px: float | None
    aspect_sd: float
    method: str  # how: "two vanishing points", "upright camera assumed", ...


@dataclass(frozen=True, slots=True, eq=False)
class Standpoint:
    """The camera of a photo, relative to one of its fronts.

    Lengths are in widths of the front, from its lower left corner: right along it, up,
    and out to the street.
    """

    size_px: tuple[int, int]  # width and height of the photo
    photo_from_camera: Matrix3  # A: focal length and principal point, in photo pixels
    focal_sd: float  # over the focal length
    position: tuple[float, float, float]
    position_sd: float  # on the ground: by focal length and direction, to first order
    front_from_camera: Matrix3  # a rotation; the camera's axes are right, down, ahead
    quad_px: Corners  # the front in the photo: tl, tr, br, bl
    roof: float  # how high this view makes the front


@dataclass(frozen=True, slots=True)
class Placard:
    """What the number board in a photo says."""

    text: str
    block: str | None  # without leading zeros
    lot: str | None
    borough: str | None  # one letter
    score: float
    box: tuple[tuple[float, float], ...]  # four corners in photo pixels


@dataclass(frozen=True, slots=True)
class Front:
    """One side of a lot on one street: a place that a facade can fill."""

    front_id: str  # block-lot-side, e.g. "993-11-2"
    block: str
    lot: str
    ring: int  # a block may hold several closed rounds of fronts
    side: int  # edge of the ring's outline, anticlockwise seen from above, from 0
    rank: int  # order along the ring, anticlockwise, from 0
    street: str
    address: str  # house number or range on that street, may be empty
    width_m: float
    depth_m: float | None
    width_assumed: bool  # not in any catalogue
    storeys: float | None = None  # of its building, as a catalogue counts them


@dataclass(frozen=True, slots=True)
class Seen:
    """A facade of a photo, as `assign` weighs it: numbers alone, no pixels."""

    photo: str  # the photo's key
    facade: int
    target: bool
    target_score: float
    score: float
    aspect: float
    aspect_sd: float
    left_px: float  # centre of the quad along x, for the order from left to right
    area_px: float  # visible pixels
    photographed: float  # share of the elevation that a camera saw
    storeys: tuple[float, ...] = ()  # a score for each of `storeys.COUNTS`
    stretched: float = 0.0  # share of what a camera saw that is smeared
    sharpness: float = 5.0  # contrast of the finest that it shows, gray levels

    @property
    def clear(self) -> float:
        """The share of the elevation that a camera saw, and not smeared."""
        return self.photographed * (1 - self.stretched)


@dataclass(frozen=True, slots=True)
class Assignment:
    """Which facade of which photo shows a front."""

    front_id: str
    photo: str
    facade: int
    score: float  # 0 to 1, comparable between photos of one front
    lent: bool = False  # by a photograph that is a record of a neighbour


Texture = tuple[str, int]  # a photo's key and a facade's index: an elevation


@dataclass(frozen=True, slots=True, eq=False)
class Wall:
    """One vertical rectangle of a building, as seen from outside."""

    start_m: tuple[float, float]  # east, north of the lower left corner
    end_m: tuple[float, float]  # east, north of the lower right corner
    front_id: str | None  # the front it stands on, if any
    texture: Texture | None  # whose elevation it wears
    evidence: int | None  # COPIED or ASSUMED, all of it; None: the texture's own


@dataclass(frozen=True, slots=True)
class Height:
    """A building's height and how it is known."""

    height_m: float
    low_m: float  # of the interval that holds it in nine of ten cases
    high_m: float
    by_storeys_m: float | None  # as its best elevation's rows of windows have it
    by_width_m: float | None  # as its width and that elevation's proportions have it
    supported: bool  # believed to lie within a quarter of the truth
    by_list_m: float | None = None  # as the storeys that a catalogue gives have it
    contradicting: tuple[str, ...] = ()  # witnesses outside the interval


@dataclass(frozen=True, slots=True, eq=False)
class Building:
    """A cuboid on one lot."""

    building_id: str  # block-lot
    footprint_m: Corners  # east, north; anticlockwise from the front's left end
    height_m: float
    walls: tuple[Wall, ...]  # one per footprint edge, in that order
    assumed: bool  # no photograph gave it its height
    height: Height | None = None  # how it is known; None where it is assumed


@dataclass(frozen=True, slots=True, eq=False)
class Block:
    """The buildings of one tax block that share one ground plane and one origin."""

    block: str
    buildings: tuple[Building, ...]
    outline_m: tuple[Points, ...]  # one closed outline a ring
    closure_m: tuple[float, ...] = ()  # by how much each ring missed its start


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Triangles that enclose buildings, anticlockwise seen from outside."""

    positions_m: Float[np.ndarray, "v 3"]  # east, north, up
    normals: Float[np.ndarray, "v 3"]
    uvs: Float[np.ndarray, "v 2"]  # (0, 0) is the top left of the atlas
    triangles: Triangles
    features: Float[np.ndarray, " v"]  # the building's number, from 0
