"""What a click on a building tells: one row a building, in the order of the block."""

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float

from nostalgin_core.cuboid import Texture
from nostalgin_core.records import Assignment, Block, Building, Front

Facts = dict[str, list[str] | np.ndarray]


def table(
    block: Block,
    fronts: Sequence[Front],
    assignments: Sequence[Assignment],
    *,
    credit_of: Mapping[str, str] | None = None,
) -> Facts:
    """List what is known of each building, as columns.

    `address` joins the building's addresses, each with its street; `photo` is the key
    of the photograph that it wears, empty where there is none; `photos` are the keys of
    all photographs that show it, joined by spaces; `credit` is that of its
    photograph, by the photo's key.
    """
    credit_of = credit_of or {}
    by_id = {front.front_id: front for front in fronts}
    own = [
        [by_id[wall.front_id] for wall in building.walls if wall.front_id in by_id]
        for building in block.buildings
    ]
    worn = [_worn(building) for building in block.buildings]
    shows = [
        sorted({one.photo for one in assignments if one.front_id in _ids(some)})
        for some in own
    ]
    return {
        "building_id": [building.building_id for building in block.buildings],
        "block": [block.block] * len(block.buildings),
        "lot": [
            some[0].lot if some else one.building_id.removeprefix(f"{block.block}-")
            for one, some in zip(block.buildings, own, strict=True)
        ],
        "address": [address(some) for some in own],
        "assumed": np.array([one.assumed for one in block.buildings], np.uint8),
        **measures(block),
        "photo": [texture[0] if texture else "" for texture in worn],
        "facade": np.array(
            [texture[1] if texture else -1 for texture in worn], np.int32
        ),
        "photos": [" ".join(some) for some in shows],
        "credit": [
            credit_of.get(texture[0], "") if texture else "" for texture in worn
        ],
    }


def measures(block: Block) -> dict[str, Float[np.ndarray, " n"]]:
    """List each building's height, and its width along its first front."""
    return {
        "height_m": np.array([one.height_m for one in block.buildings], np.float32),
        "width_m": np.array([_width(one) for one in block.buildings], np.float32),
    }


def address(fronts: Sequence[Front]) -> str:
    """Join a building's addresses: "561-565 7 Avenue, 155 West 40 Street".

    A second front without a house number adds its street in brackets.
    """
    numbered = [f"{one.address} {one.street}".strip() for one in fronts if one.address]
    bare = [one.street for one in fronts if not one.address and one.street]
    if not numbered:
        return ", ".join(dict.fromkeys(bare))
    return ", ".join(dict.fromkeys([*numbered, *(f"({street})" for street in bare)]))


def bounds(
    block: Block,
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Find the lowest and highest corner of a block: east, north, up, in metres."""
    ground = np.concatenate([one.footprint_m for one in block.buildings])
    top = max(one.height_m for one in block.buildings)
    (east0, north0), (east1, north1) = ground.min(axis=0), ground.max(axis=0)
    low = (float(east0), float(north0), 0.0)
    return low, (float(east1), float(north1), float(top))


def _ids(fronts: Sequence[Front]) -> set[str]:
    return {front.front_id for front in fronts}


def _worn(building: Building) -> Texture | None:
    textures = [wall.texture for wall in building.walls if wall.texture is not None]
    return textures[0] if textures else None


def _width(building: Building) -> float:
    return float(np.hypot(*(building.footprint_m[1] - building.footprint_m[0])))
