"""What a click on a building tells: one row a building, in the order of the block."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from nostalgin_core.block import Settled
from nostalgin_core.records import Block, Building, Front


def table(settled: Settled) -> dict[str, list[str]]:
    """List what is known of each building in words, as columns.

    `address` joins the building's addresses, each with its street; `photo` is the key
    of the photograph that it wears, empty where there is none; `photos` are the keys of
    all photographs that show it, joined by spaces.
    """
    buildings = settled.block.buildings
    own = [settled.fronts_of(one.building_id) for one in buildings]
    return {
        "id": [one.building_id for one in buildings],
        "block": [settled.block.block] * len(buildings),
        "lot": [fronts[0].lot if fronts else "" for fronts in own],
        "address": [address(fronts) for fronts in own],
        "assumed": ["yes" if one.assumed else "no" for one in buildings],
        "photo": [_worn(one) for one in buildings],
        "photos": [_showing(settled, fronts) for fronts in own],
    }


def measures(block: Block) -> dict[str, Float[np.ndarray, " n"]]:
    """List each building's height, and its width along its first front."""
    return {
        "height_m": np.array([one.height_m for one in block.buildings], np.float32),
        "width_m": np.array([_width(one) for one in block.buildings], np.float32),
    }


def address(fronts: Sequence[Front]) -> str:
    """Join a building's addresses: "561-565 7 Avenue; 155 West 40 Street"."""
    return "; ".join(f"{one.address} {one.street}".strip() for one in fronts)


def _worn(building: Building) -> str:
    textures = [wall.texture for wall in building.walls if wall.texture is not None]
    return textures[0][0] if textures else ""


def _showing(settled: Settled, fronts: Sequence[Front]) -> str:
    ids = {front.front_id for front in fronts}
    shown = {one.photo for one in settled.assignments if one.front_id in ids}
    return " ".join(sorted(shown))


def _width(building: Building) -> float:
    return float(np.hypot(*(building.footprint_m[1] - building.footprint_m[0])))
