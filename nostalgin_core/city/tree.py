"""A city as a tree of tiles: the city, districts of neighbours, blocks.

    root                      no content
      district of districts   a volume a block
        district              a volume a building, gray
          block, coarse       photographs of at most 128 texels
            block, fine       the block's own GLB

Each level is drawn in place of the one above it (`REPLACE`) as soon as that one's error
shows. Every tile draws what lies two levels below it, and no tile has more than 16
children, so what must be read for any view is bounded, however large the city. A city
of up to 16 blocks needs no districts; one of more than 256 has a file a district.
"""

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from jaxtyping import Float

from nostalgin_core import model
from nostalgin_core.city.groups import MOST, Group, grouped
from nostalgin_core.city.tileset import (
    MARGIN_M,
    Json,
    Matrix4,
    Place,
    Tile,
    box,
    box_corners,
    carried,
    city_from_block,
    columns,
    ecef_from_enu,
    leaf,
)
from nostalgin_core.city.volumes import Lump, joined, lump, smaller_sides, stood

INLINE = MOST * MOST  # blocks, up to which one file tells all

Low = Float[np.ndarray, " 3"]
High = Float[np.ndarray, " 3"]


@dataclass(frozen=True, slots=True)
class Tree:
    """A tileset, the files that it names beside the blocks' own, and all frames."""

    tileset: Json
    files: dict[str, Callable[[], bytes]]  # named by content; made when asked for
    frames: list[list[float]]  # city_from_block of each tile, column by column


@dataclass(frozen=True, slots=True)
class _Node:
    tile: Json
    low: Low  # in the city's frame
    high: High


@dataclass(frozen=True, slots=True, eq=False)
class _City:
    """All there is to draw, and what was written of it."""

    tiles: Sequence[Tile]
    frames: Sequence[Matrix4]
    apart: bool  # a file a district
    files: dict[str, Callable[[], bytes]] = field(default_factory=dict)
    lumps: dict[int, Lump] = field(default_factory=dict)  # of blocks, made once


def tree(
    tiles: Sequence[Tile],
    *,
    place: Place | None = None,
    version: str = "",
    inline: int = INLINE,
) -> Tree:
    """Describe a city as 3D Tiles 1.1.

    Without a `place` the root has no transform, and the city lies on a plane at the
    origin. The root's geometric error is the city's diagonal, so that it is entered as
    soon as the whole city covers about sixteen pixels.

    Raises:
        ValueError: if there is no tile, or if a tile has a place and the city has none.
    """
    if not tiles:
        raise ValueError("a city needs at least one block")
    frames = [city_from_block(tile, place) for tile in tiles]
    city = _City(tiles, frames, len(tiles) > inline)
    middles = [
        carried(frame, _middle(tile))[0, :2]
        for tile, frame in zip(tiles, frames, strict=True)
    ]
    top = grouped(np.array(middles))
    nodes = [_below(city, one) for one in _members(top)]
    low, high = _bounds(nodes)
    error = float(np.ceil(np.linalg.norm(high - low)))
    error = max(error, *(node.tile["geometricError"] for node in nodes))
    root: Json = {
        "boundingVolume": {"box": box(low, high)},
        "geometricError": error,
        "refine": "ADD",
        "children": [node.tile for node in nodes],
    }
    if place is not None:
        root["transform"] = columns(ecef_from_enu(place))
    asset = {"version": "1.1", "generator": "nostalgin"}
    if version:
        asset["tilesetVersion"] = version
    told = {"asset": asset, "geometricError": error, "root": root}
    return Tree(told, city.files, [columns(frame) for frame in frames])


def _members(group: Group) -> Sequence[Group | int]:
    return group.groups or group.blocks


def _below(city: _City, member: Group | int) -> _Node:
    """Write a block's tile, or a district's."""
    if isinstance(member, int):
        tile, frame = city.tiles[member], city.frames[member]
        corners = carried(frame, box_corners(tile.low_m, tile.high_m))
        return _Node(leaf(tile, frame), corners.min(axis=0), corners.max(axis=0))
    nodes = [_below(city, one) for one in _members(member)]
    low, high = _bounds(nodes)
    make = partial(_massing, city, member)
    error = max(_error(city, member), *(node.tile["geometricError"] for node in nodes))
    inner = {
        "boundingVolume": {"box": box(low, high)},
        "geometricError": error,
        "refine": "REPLACE",
        "content": {"uri": _file(city, "far/{}.glb", make)},
        "children": [node.tile for node in nodes],
    }
    return _Node(_apart(city, inner) if city.apart else inner, low, high)


def _apart(city: _City, inner: Json) -> Json:
    """Put a district into a file of its own."""
    asset = {"version": "1.1", "generator": "nostalgin"}
    told = {"asset": asset, "geometricError": inner["geometricError"], "root": inner}
    data = json.dumps(told, separators=(",", ":"), allow_nan=False).encode()
    name = _file(city, "tiles-{}.json", lambda: data)
    kept = {key: inner[key] for key in ("boundingVolume", "geometricError", "refine")}
    return kept | {"content": {"uri": name}}


def _file(city: _City, pattern: str, make: Callable[[], bytes]) -> str:
    name = pattern.format(hashlib.sha256(make()).hexdigest()[:16])
    city.files[name] = make
    return name


def _bounds(nodes: Sequence[_Node]) -> tuple[Low, High]:
    low = np.min([node.low for node in nodes], axis=0) - MARGIN_M
    return low, np.max([node.high for node in nodes], axis=0) + MARGIN_M


def _massing(city: _City, group: Group) -> bytes:
    """Draw the volumes of what lies two levels below."""
    if group.blocks:
        own = [stood(city.tiles[n], city.frames[n]) for n in group.blocks]
        return model.massing(own, extras={"volumes": "buildings"})
    lumps = [one.volume for one in _grandchildren(city, group)]
    return model.massing(lumps, extras={"volumes": "blocks"})


def _error(city: _City, group: Group) -> float:
    """Tell by how much the volumes of a district are wrong, in metres.

    Buildings have their true measures but no photograph: what is missing is up to as
    large as the smaller side of a wall, here the median building's. A volume that
    stands for a block, or for a district, is wrong by `Lump.wrong_m`.
    """
    if group.blocks:
        sizes = [smaller_sides(city.tiles[number]) for number in group.blocks]
        return round(float(np.median(np.concatenate(sizes))), 3)
    return round(max(one.wrong_m for one in _grandchildren(city, group)), 3)


def _grandchildren(city: _City, group: Group) -> Iterator[Lump]:
    """Make one volume of each thing that lies two levels below."""
    for child in group.groups:
        for one in _members(child):
            numbers = [one] if isinstance(one, int) else one.all_blocks()
            yield joined([_lump(city, number) for number in numbers])


def _lump(city: _City, number: int) -> Lump:
    if number not in city.lumps:
        city.lumps[number] = lump(city.tiles[number], city.frames[number])
    return city.lumps[number]


def _middle(tile: Tile) -> Float[np.ndarray, "1 3"]:
    return (np.array([tile.low_m]) + np.array([tile.high_m])) / 2
