"""The same block with fewer texels, for those who stand far from it.

The geometry is the fine model's, corner for corner; every tile of the atlas is scaled
down, and the texture coordinates follow their tiles.
"""

from typing import Final

import numpy as np
from jaxtyping import Float

from nostalgin_core import evidence
from nostalgin_core.model.atlas import (
    PATCH_PX,
    TONES,
    Atlas,
    blank,
    draw,
    layout,
    scaled_sizes,
    tone,
)
from nostalgin_core.records import Box, Mesh

COARSE_PX: Final = 128  # longest side of a tile: an eighth of the fine one's
LEAST_TEXELS: Final = 2.0  # a coarser atlas than half the fine one is worth a file

UVs = Float[np.ndarray, "v 2"]


def coarser(fine: Atlas, *, longest_px: int = COARSE_PX) -> Atlas:
    """Scale every tile of an atlas down; evidence never claims more than before."""
    keys = list(fine.tiles)
    sizes = [_size(fine.tiles[key]) for key in keys]
    sizes = scaled_sizes(sizes, scale=1.0, longest_px=longest_px)
    sizes += [(PATCH_PX, PATCH_PX)] * len(TONES)
    made = blank(keys, *layout(sizes, longest_px=longest_px, limit_px=4096))
    for key, box in made.tiles.items():
        tile = _slices(fine.tiles[key])
        kept = fine.opacity[tile] > 0
        draw(made, box, fine.image[tile], kept, fine.evidence[tile])
    tone(made)
    return made


def carried(uvs: UVs, fine: Atlas, coarse: Atlas) -> UVs:
    """Carry texture coordinates from the tiles of one atlas to the other's.

    Raises:
        ValueError: if one lies in no tile.
    """
    fines, coarses = _edges(fine), _edges(coarse)
    points = uvs * fine.image.shape[::-1]
    slack = 1e-3  # of a texel; tiles lie sixteen apart
    low, high = fines[:, :2] - slack, fines[:, 2:] + slack
    inside = (points[:, None] >= low) & (points[:, None] <= high)
    whole = np.logical_and(inside[..., 0], inside[..., 1])
    found = np.count_nonzero(whole, axis=1) > 0
    if not found.all():
        astray = uvs[~found][0]
        raise ValueError(f"texture coordinate {astray.tolist()} lies in no tile")
    tile = np.argmax(whole, axis=1)
    spans = fines[tile, 2:] - fines[tile, :2]
    along = (points - fines[tile, :2]) / spans
    moved = coarses[tile, :2] + along * (coarses[tile, 2:] - coarses[tile, :2])
    return moved / coarse.image.shape[::-1]


def texel_m(mesh: Mesh, atlas: Atlas) -> float:
    """Measure the largest texel on any wall, in metres; patches have no detail."""
    h, w = atlas.image.shape
    corners = mesh.positions_m[mesh.triangles]
    uvs = mesh.uvs[mesh.triangles] * [w, h]
    largest = 0.0
    edges = _edges(atlas)[: len(atlas.tiles)]
    middle = uvs.mean(axis=1)[:, None]
    inside = (middle >= edges[:, :2]) & (middle <= edges[:, 2:])
    worn = np.count_nonzero(inside[..., 0] & inside[..., 1], axis=1) > 0
    for start, end in ((0, 1), (1, 2), (2, 0)):
        metres = np.linalg.norm(corners[:, end] - corners[:, start], axis=1)
        texels = np.linalg.norm(uvs[:, end] - uvs[:, start], axis=1)
        across = metres[worn] / np.maximum(texels[worn], 1.0)
        largest = max(largest, float(across.max(initial=0.0)))
    return largest


def worthwhile(fine: Atlas, coarse: Atlas) -> bool:
    """Tell whether a coarse atlas saves enough texels to be a file of its own."""
    photographed = bool((fine.evidence != evidence.ASSUMED).any())
    return photographed and fine.image.size >= LEAST_TEXELS * coarse.image.size


def _edges(atlas: Atlas) -> Float[np.ndarray, "t 4"]:
    boxes = [*atlas.tiles.values(), *atlas.patches]
    return np.array([[b.x0, b.y0, b.x1, b.y1] for b in boxes], float)


def _size(box: Box) -> tuple[int, int]:
    return box.y1 - box.y0, box.x1 - box.x0


def _slices(box: Box) -> tuple[slice, slice]:
    return slice(box.y0, box.y1), slice(box.x0, box.x1)
