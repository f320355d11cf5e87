"""What blocks look like from far away: a volume a building, or one for all of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from jaxtyping import Float

from nostalgin_core.city.tileset import Footprints, Matrix4, Tile, carried
from nostalgin_core.model import Volumes

Heights = Float[np.ndarray, " n"]


@dataclass(frozen=True, slots=True, eq=False)
class Lump:
    """One convex volume that stands for some buildings, and what it conceals."""

    outline_m: Float[np.ndarray, "n 3"]  # on the ground, anticlockwise
    ground_m2: float  # that the buildings cover
    height_m: float  # of the mean square metre
    lowest_m: float  # building
    highest_m: float

    @property
    def wrong_m(self) -> float:
        """Tell by how much it is wrong.

        That is by the height of what sticks out of it, or by the side of a square as
        large as the ground that it covers and no building does.
        """
        hull = shapely.Polygon(self.outline_m[:, :2]).area
        rise = max(self.highest_m - self.height_m, self.height_m - self.lowest_m)
        return max(rise, float(np.sqrt(max(hull - self.ground_m2, 0.0))))

    @property
    def volume(self) -> Volumes:
        """Stand it up."""
        up = np.array([0.0, 0.0, self.height_m])
        return Volumes(self.outline_m[None], (self.outline_m + up)[None])


def told(tile: Tile) -> tuple[Footprints, Heights]:
    """Give a block's footprints and heights; where none are told, its bounds."""
    if tile.footprints_m is not None and tile.heights_m is not None:
        return tile.footprints_m, tile.heights_m
    (east0, north0, _), (east1, north1, top) = tile.low_m, tile.high_m
    ground = [[east0, north0], [east1, north0], [east1, north1], [east0, north1]]
    return np.array([ground], float), np.array([top], float)


def stood(tile: Tile, frame: Matrix4) -> Volumes:
    """Stand a block's buildings up, in the city's frame."""
    grounds, heights = told(tile)
    flat = np.concatenate([grounds, np.zeros((len(grounds), 4, 1))], axis=2)
    raised = flat + heights[:, None, None] * np.array([0.0, 0.0, 1.0])
    low, high = (carried(frame, one.reshape(-1, 3)) for one in (flat, raised))
    return Volumes(low.reshape(-1, 4, 3), high.reshape(-1, 4, 3))


def smaller_sides(tile: Tile) -> Heights:
    """Measure each building's width or height, whichever is less."""
    grounds, heights = told(tile)
    widths = np.linalg.norm(grounds[:, 1] - grounds[:, 0], axis=1)
    return np.minimum(widths, heights)


def lump(tile: Tile, frame: Matrix4) -> Lump:
    """Put a block's buildings into one volume."""
    grounds, heights = told(tile)
    x, y = np.moveaxis(grounds, 2, 0)
    ahead_x, ahead_y = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    areas = np.abs((x * ahead_y - ahead_x * y).sum(axis=1)) / 2
    corners = stood(tile, frame).low_m.reshape(-1, 3)
    return Lump(
        hull(corners),
        float(areas.sum()),
        float(np.average(heights, weights=np.maximum(areas, 1e-6))),
        float(heights.min()),
        float(heights.max()),
    )


def joined(lumps: Sequence[Lump]) -> Lump:
    """Put volumes into one."""
    areas = [one.ground_m2 for one in lumps]
    heights = [one.height_m for one in lumps]
    return Lump(
        hull(np.concatenate([one.outline_m for one in lumps])),
        sum(areas),
        float(np.average(heights, weights=np.maximum(areas, 1e-6))),
        min(one.lowest_m for one in lumps),
        max(one.highest_m for one in lumps),
    )


def hull(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "m 3"]:
    """Find the convex outline of points seen from above, on their lowest ground."""
    flat = shapely.MultiPoint(points[:, :2]).convex_hull
    if flat.geom_type != "Polygon":  # all on a line, or at one point
        flat = flat.buffer(0.5, quad_segs=1).convex_hull
    ring = shapely.get_coordinates(shapely.normalize(flat))[:-1]
    ring = ring if shapely.LinearRing(ring).is_ccw else ring[::-1]
    return np.column_stack([ring, np.full(len(ring), points[:, 2].min())])
