"""One block from its facades: who shows which front, cuboids, one model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from nostalgin_core import assign, atlas, block, corner, facts, gltf, mesh, picture
from nostalgin_core.records import (
    Assignment,
    Block,
    Elevation,
    Front,
    Mesh,
    Rejection,
    Seen,
)


@dataclass(frozen=True, slots=True, eq=False)
class Settled:
    """A block whose facades have their fronts, and whose cuboids stand."""

    fronts: tuple[Front, ...]  # with the corners that photographs told
    assignments: tuple[Assignment, ...]
    rejections: tuple[Rejection, ...]
    block: Block

    def worn(self) -> tuple[tuple[str, int], ...]:
        """List the facades that a wall wears: only these need inpainting."""
        textures = {
            wall.texture
            for building in self.block.buildings
            for wall in building.walls
            if wall.texture is not None
        }
        return tuple(sorted(textures))


def settle(
    name: str,
    fronts: Sequence[Front],
    candidates: Mapping[str, Sequence[str]],
    seen: Sequence[Seen],
) -> Settled:
    """Give a block's facades to its fronts, and raise its buildings.

    `candidates` names for each photo, by key, the fronts that it may show.
    """
    two = assign.two_fronted(fronts, candidates, seen)
    turned = corner.with_corners(fronts, two)
    outcomes = assign.assign(turned, candidates, seen)
    assignments = tuple(one for one in outcomes if isinstance(one, Assignment))
    rejections = tuple(one for one in outcomes if isinstance(one, Rejection))
    return Settled(
        turned, assignments, rejections, raised(name, turned, assignments, seen)
    )


def raised(
    name: str,
    fronts: Sequence[Front],
    assignments: Sequence[Assignment],
    seen: Sequence[Seen],
) -> Block:
    """Raise a block's buildings from the proportions of the facades they wear."""
    aspects = {(one.photo, one.facade): (one.aspect, one.aspect_sd) for one in seen}
    return block.block(name, fronts, assignments, aspects)


def model(
    one: Block,
    elevations: Mapping[tuple[str, int], Elevation],
    *,
    table: Mapping[str, Sequence[str]],
    credit: str = "",
) -> tuple[bytes, Mesh]:
    """Make a block's GLB from its cuboids and the finished elevations they wear.

    Returns its bytes, and all its buildings as one mesh, to be measured.
    """
    pages = atlas.build(
        {
            (*wall.texture, wall.evidence): elevations[wall.texture]
            for building in one.buildings
            for wall in building.walls
            if wall.texture is not None
        }
    )
    meshes = [
        (building.building_id, mesh.building(building, pages, number=number))
        for number, building in enumerate(one.buildings)
    ]
    data = gltf.glb(
        one.block,
        meshes,
        colours=picture.colours(pages),
        evidence=picture.evidence_key(pages),
        table={
            **table,
            "credit": [credit] * len(one.buildings),
            **facts.measures(one),
        },
        copyright=credit,
        extras={"block": one.block, "evidence": picture.legend()},
    )
    return data, mesh.joined([each for _, each in meshes])


def table(one: Settled) -> dict[str, list[str]]:
    """Write what a click on a building tells, a row a building."""
    own = [fronts_of(one, b.building_id) for b in one.block.buildings]
    known = facts.table(one.block, one.fronts, one.assignments)
    return {
        "id": [b.building_id for b in one.block.buildings],
        "block": list(known["block"]),
        "lot": [fronts[0].lot if fronts else "" for fronts in own],
        "address": ["; ".join(address(front) for front in some) for some in own],
        "assumed": ["yes" if b.assumed else "no" for b in one.block.buildings],
        "photo": list(known["photo"]),
        "photos": list(known["photos"]),
    }


def fronts_of(one: Settled, building_id: str) -> list[Front]:
    """List the fronts of one building, in ring order."""
    walls = next(
        building.walls
        for building in one.block.buildings
        if building.building_id == building_id
    )
    own = {wall.front_id for wall in walls}
    return [front for front in one.fronts if front.front_id in own]


def address(front: Front) -> str:
    """Write a front's address in one line."""
    return f"{front.address} {front.street}".strip()
