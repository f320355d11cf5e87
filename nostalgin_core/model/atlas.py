"""One image a block: every wall's texture side by side, with its evidence.

A tile is an elevation scaled to a budget of texels and put on a shelf of the atlas. The
evidence atlas has the same layout, so that one set of texture coordinates serves both.
Round each tile runs a gutter that repeats its border, so that mipmaps and linear
sampling never mix two fronts. A few patches of flat gray serve plain walls and roofs.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import UInt8
from scipy import ndimage

from nostalgin_core import evidence
from nostalgin_core.arrays import EvidenceMap, Gray, Mask
from nostalgin_core.records import Block, Box, Elevation

TileKey = tuple[str, int, int | None]  # photo key, facade, evidence of the whole wall
Size = tuple[int, int]

LIMIT_PX = 4096  # what every GPU of the last ten years takes
GUTTER_PX = 8  # keeps tiles apart down to the third mipmap
LONGEST_PX = 1024  # a storey of 3.5 m keeps 60 texels or more in a ten-storey front
LEAST_PX = 4  # of a tile's side
PATCH_PX = 16
TONES = (64, 84, 104, 124, 144)  # of plain walls and roofs, dark to light


@dataclass(frozen=True, slots=True, eq=False)
class Atlas:
    """The textures of one block. Its three arrays share a size."""

    image: Gray
    opacity: UInt8[np.ndarray, "h w"]  # 0 where a wall is not there, else 255
    evidence: EvidenceMap
    tiles: Mapping[TileKey, Box]  # without gutters
    patches: tuple[Box, ...]  # of one tone each, in the order of TONES


def wanted(block: Block) -> list[TileKey]:
    """List the tiles that a block's walls show, in order of their keys."""
    keys = {
        (*wall.texture, wall.evidence)
        for building in block.buildings
        for wall in building.walls
        if wall.texture is not None
    }
    return sorted(keys, key=lambda key: (key[0], key[1], key[2] or 0))


def opaque(elevation: Elevation) -> Mask:
    """Tell the texels of a finished elevation that belong to the front.

    What was hidden and filled counts in full. A soft texel at the sky (within three
    texels of what is not the front) counts where at least half of it is front.
    """
    absent = elevation.evidence == evidence.NOTHING
    cross = np.ones((3, 3), np.uint8)
    near_sky = cv2.dilate(absent.astype(np.uint8), cross, iterations=3) > 0
    soft = elevation.evidence == evidence.SOFT_EDGE
    return ~absent & ~(soft & near_sky & (elevation.alpha < 0.5))


def bled(image: Gray, kept: Mask) -> Gray:
    """Give each texel outside `kept` the value of the nearest one inside.

    It is never seen, but mipmaps and linear sampling read it.
    """
    if kept.all() or not kept.any():
        return image
    nearest = np.zeros((2, *kept.shape), np.int32)
    ndimage.distance_transform_edt(
        ~kept, return_distances=False, return_indices=True, indices=nearest
    )
    return image[nearest[0], nearest[1]]


def scaled_codes(
    codes: EvidenceMap, size: tuple[int, int]
) -> UInt8[np.ndarray, "rows columns"]:
    """Scale an evidence map to a size (w, h) without ever claiming too much.

    Each texel takes the nearest code, but says PHOTOGRAPHED only where every texel that
    its colour is averaged from was photographed; else it is a SOFT_EDGE.
    """
    nearest = cv2.resize(codes, size, interpolation=cv2.INTER_NEAREST_EXACT)
    sure = (codes == evidence.PHOTOGRAPHED).astype(np.float32)
    share = cv2.resize(sure, size, interpolation=cv2.INTER_AREA)
    mixed = (nearest == evidence.PHOTOGRAPHED) & (share < 0.999)
    return np.where(mixed, evidence.SOFT_EDGE, nearest).astype(np.uint8)


def shelves(
    sizes: Sequence[tuple[int, int]], *, width: int
) -> tuple[list[tuple[int, int]], int]:
    """Put rectangles (h, w) on shelves of one width; return corners (x, y) and height.

    They go tallest first, equal ones in the order given.

    Raises:
        ValueError: if a rectangle is wider than a shelf.
    """
    corners = [(0, 0)] * len(sizes)
    x = y = shelf = 0
    for index in sorted(range(len(sizes)), key=lambda index: -sizes[index][0]):
        h, w = sizes[index]
        if w > width:
            raise ValueError(f"a tile {w} px wide does not fit a shelf of {width} px")
        if x + w > width:
            x, y, shelf = 0, y + shelf, 0
        corners[index] = (x, y)
        x, shelf = x + w, max(shelf, h)
    return corners, y + shelf


def scaled_sizes(
    sizes: Sequence[tuple[int, int]], *, scale: float, longest_px: int
) -> list[tuple[int, int]]:
    """Scale sizes (h, w), none beyond a longest side, none below four texels."""
    factors = [min(scale, longest_px * scale / max(size), 1.0) for size in sizes]
    return [
        (max(LEAST_PX, round(h * f)), max(LEAST_PX, round(w * f)))
        for (h, w), f in zip(sizes, factors, strict=True)
    ]


def layout(
    sizes: Sequence[tuple[int, int]], *, longest_px: int, limit_px: int
) -> tuple[list[Box], tuple[int, int]]:
    """Lay tiles out in the smallest of the widths 256, 512 ... that keeps it squarish.

    Where even the widest atlas is too small, all tiles shrink by the same factor, a
    step of a tenth at a time. Returns the boxes of the tiles and the atlas's (h, w).

    Raises:
        ValueError: if not even tiles of four texels fit.
    """
    scale = 1.0
    while True:
        inner = scaled_sizes(sizes, scale=scale, longest_px=longest_px)
        outer = [(h + 2 * GUTTER_PX, w + 2 * GUTTER_PX) for h, w in inner]
        width = 256
        while width <= limit_px:
            if max(w for _, w in outer) <= width:
                corners, height = shelves(outer, width=width)
                if height <= min(width * 5 // 4, limit_px):
                    boxes = [
                        Box(
                            x + GUTTER_PX,
                            y + GUTTER_PX,
                            x + GUTTER_PX + w,
                            y + GUTTER_PX + h,
                        )
                        for (x, y), (h, w) in zip(corners, inner, strict=True)
                    ]
                    return boxes, (-(-height // 64) * 64, width)
            width *= 2
        if max(map(max, inner)) <= LEAST_PX:
            raise ValueError(f"{len(sizes)} tiles fit no atlas of {limit_px} px")
        scale *= 0.9


def build(
    elevations: Mapping[TileKey, Elevation],
    *,
    longest_px: int = LONGEST_PX,
    copied_px: int = 256,
    limit_px: int = LIMIT_PX,
) -> Atlas:
    """Draw the atlas of one block.

    A key whose last entry is a code gets a smaller tile of its own (`copied_px`), for
    the same pixels are then evidence of that kind.
    """
    keys = sorted(elevations, key=lambda key: (key[0], key[1], key[2] or 0))
    sizes = []
    for key in keys:
        h, w = elevations[key].image.shape
        budget = longest_px if key[2] is None else copied_px
        sizes.append(scaled_sizes([(h, w)], scale=1.0, longest_px=budget)[0])
    sizes += [(PATCH_PX, PATCH_PX)] * len(TONES)
    boxes, shape = layout(sizes, longest_px=longest_px, limit_px=limit_px)
    atlas = blank(keys, boxes, shape)
    for key, box in atlas.tiles.items():
        one = elevations[key]
        kept = opaque(one)
        draw(atlas, box, bled(one.image, kept), kept, one.evidence, code=key[2])
    tone(atlas)
    return atlas


def blank(keys: Sequence[TileKey], boxes: Sequence[Box], shape: Size) -> Atlas:
    """Make an atlas that shows nothing yet; its patches have the last boxes."""
    return Atlas(
        image=np.full(shape, TONES[2], np.uint8),
        opacity=np.full(shape, 255, np.uint8),
        evidence=np.full(shape, evidence.ASSUMED, np.uint8),
        tiles=dict(zip(keys, boxes[: len(keys)], strict=True)),
        patches=tuple(boxes[len(keys) :]),
    )


def tone(atlas: Atlas) -> None:
    """Paint the patches of flat gray, gutters included."""
    for gray, box in zip(TONES, atlas.patches, strict=True):
        atlas.image[_with_gutter(box)] = gray


def _with_gutter(box: Box) -> tuple[slice, slice]:
    return (
        slice(box.y0 - GUTTER_PX, box.y1 + GUTTER_PX),
        slice(box.x0 - GUTTER_PX, box.x1 + GUTTER_PX),
    )


def draw(
    atlas: Atlas,
    box: Box,
    image: Gray,
    kept: Mask,
    codes: EvidenceMap,
    *,
    code: int | None = None,
) -> None:
    """Scale an image with its opacity and its evidence to a tile, and put it there."""
    size = (box.x1 - box.x0, box.y1 - box.y0)
    small = cv2.resize(image, size, interpolation=cv2.INTER_AREA)
    opacity = cv2.resize(kept.astype(np.float32), size, interpolation=cv2.INTER_AREA)
    solid = opacity >= 0.5
    scaled = scaled_codes(codes, size)
    if code is not None:
        scaled = np.full_like(scaled, code)
    scaled[solid & (scaled == evidence.NOTHING)] = evidence.SOFT_EDGE
    scaled[~solid] = evidence.NOTHING
    for target, tile in (
        (atlas.image, small),
        (atlas.opacity, np.where(solid, 255, 0).astype(np.uint8)),
        (atlas.evidence, scaled),
    ):
        target[_with_gutter(box)] = np.pad(tile, GUTTER_PX, mode="edge")
