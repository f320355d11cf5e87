"""One block from its facades: who shows which front, and which cuboids follow."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from nostalgin_core.block import assign, block, corner
from nostalgin_core.records import (
    Assignment,
    Block,
    Front,
    Rejection,
    Seen,
    Texture,
)


@dataclass(frozen=True, slots=True, eq=False)
class Settled:
    """A block whose facades have their fronts, and whose cuboids stand."""

    fronts: tuple[Front, ...]  # with the corners that photographs told
    assignments: tuple[Assignment, ...]
    rejections: tuple[Rejection, ...]
    block: Block

    def worn(self) -> tuple[Texture, ...]:
        """List the facades that a wall wears: only these need inpainting."""
        textures = {
            wall.texture
            for building in self.block.buildings
            for wall in building.walls
            if wall.texture is not None
        }
        return tuple(sorted(textures))

    def fronts_of(self, building_id: str) -> list[Front]:
        """List the fronts of one building, in ring order."""
        walls = next(
            building.walls
            for building in self.block.buildings
            if building.building_id == building_id
        )
        own = {wall.front_id for wall in walls}
        return [front for front in self.fronts if front.front_id in own]


def settle(
    name: str,
    fronts: Sequence[Front],
    candidates: Mapping[str, Sequence[str]],
    seen: Sequence[Seen],
    *,
    heights_m: Mapping[str, float] | None = None,
) -> Settled:
    """Give a block's facades to its fronts, and raise its buildings.

    `candidates` names for each photo, by key, the fronts that it may show; `heights_m`
    are heights that are known, by building.
    """
    two = assign.two_fronted(fronts, candidates, seen)
    turned = corner.with_corners(fronts, two)
    outcomes = assign.assign(turned, candidates, seen)
    assignments = tuple(one for one in outcomes if isinstance(one, Assignment))
    rejections = tuple(one for one in outcomes if isinstance(one, Rejection))
    stands = raised(name, turned, assignments, seen, heights_m=heights_m)
    return Settled(turned, assignments, rejections, stands)


def raised(
    name: str,
    fronts: Sequence[Front],
    assignments: Sequence[Assignment],
    seen: Sequence[Seen],
    *,
    heights_m: Mapping[str, float] | None = None,
) -> Block:
    """Raise a block's buildings from the proportions of the facades they wear."""
    aspects = {
        (one.photo, one.facade): {
            "aspect": one.aspect,
            "aspect_sd": one.aspect_sd,
            "storeys": one.storeys,
            "clear": one.clear,
        }
        for one in seen
    }
    return block.block(name, fronts, assignments, aspects, heights_m=heights_m)
