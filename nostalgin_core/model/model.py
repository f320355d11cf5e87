"""One block becomes one file: cuboids, the elevations they wear, and what is known."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from nostalgin_core.block import Settled
from nostalgin_core.model import atlas, coarse, facts, gltf, mesh, picture, yards
from nostalgin_core.model.atlas import Atlas
from nostalgin_core.model.picture import ImageFormat
from nostalgin_core.model.rights import Rights
from nostalgin_core.records import Elevation, Mesh, Texture


@dataclass(frozen=True, slots=True, eq=False)
class Modelled:
    """A block's model, fine and coarse."""

    glb: bytes
    mesh: Mesh  # all its buildings, to be measured
    coarse: bytes  # the same geometry with fewer texels; empty where that saves nothing
    coarse_texel_m: float  # the largest texel of the coarse one


def model(
    settled: Settled,
    elevations: Mapping[Texture, Elevation],
    *,
    rights: Rights | None = None,
    image_format: ImageFormat = "webp",
) -> Modelled:
    """Make a block's GLB from its cuboids and the finished elevations they wear.

    With `image_format` "png" no reader needs EXT_texture_webp.
    """
    one = settled.block
    fine = atlas.build({key: elevations[key[:2]] for key in atlas.wanted(one)})
    meshes = [
        (building.building_id, mesh.building(building, fine, number=number))
        for number, building in enumerate(one.buildings)
    ]
    rights = rights or Rights()
    write = _Writer(settled, rights, image_format)
    small = coarse.coarser(fine)
    if not coarse.worthwhile(fine, small):
        whole = mesh.joined([each for _, each in meshes])
        return Modelled(write(meshes, fine), whole, b"", 0.0)
    far = [
        (name, replace(each, uvs=coarse.carried(each.uvs, fine, small)))
        for name, each in meshes
    ]
    return Modelled(
        glb=write(meshes, fine),
        mesh=mesh.joined([each for _, each in meshes]),
        coarse=write(far, small),
        coarse_texel_m=coarse.texel_m(mesh.joined([each for _, each in far]), small),
    )


@dataclass(frozen=True, slots=True)
class _Writer:
    """What the fine and the coarse model have in common."""

    settled: Settled
    rights: Rights
    image_format: ImageFormat

    def __call__(self, meshes: list[tuple[str, Mesh]], pages: Atlas) -> bytes:
        """Write one of them."""
        one = self.settled.block
        return gltf.glb(
            one.block,
            meshes,
            ground=yards.yards(one, pages),
            colours=picture.colours(pages, image_format=self.image_format),
            evidence=picture.evidence_key(pages),
            table={
                **facts.table(self.settled),
                "credit": [self.rights.credit] * len(one.buildings),
                **facts.measures(one),
            },
            copyright=self.rights.line,
            extras={
                "block": one.block,
                "evidence": picture.legend(),
                **self.rights.extras,
            },
        )
