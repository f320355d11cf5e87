"""One block becomes one file: cuboids, the elevations they wear, and what is known."""

from collections.abc import Mapping

from nostalgin_core.block import Settled
from nostalgin_core.model import atlas, facts, gltf, mesh, picture
from nostalgin_core.records import Elevation, Mesh, Texture


def model(
    settled: Settled,
    elevations: Mapping[Texture, Elevation],
    *,
    credit: str = "",
    photographs: Mapping[str, Mapping[str, str]] | None = None,
) -> tuple[bytes, Mesh]:
    """Make a block's GLB from its cuboids and the finished elevations they wear.

    `photographs` tells the rights, licence and date of each that it wears, by key; they
    stand in the file's `asset.extras`, where anything is told.
    Returns its bytes, and all its buildings as one mesh, to be measured.
    """
    one = settled.block
    pages = atlas.build({key: elevations[key[:2]] for key in atlas.wanted(one)})
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
            **facts.table(settled),
            "credit": [credit] * len(one.buildings),
            **facts.measures(one),
        },
        copyright=credit,
        extras={
            "block": one.block,
            "evidence": picture.legend(),
            **({"photographs": photographs} if photographs else {}),
        },
    )
    return data, mesh.joined([each for _, each in meshes])
