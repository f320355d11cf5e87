from dataclasses import replace

import numpy as np
import pytest
import trimesh

from nostalgin_core import evidence
from nostalgin_core.model import atlas, mesh
from nostalgin_core.records import Building, Mesh, Wall
from tests.core import sample_block as sample

FOOTPRINT = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 6.0], [0.0, 6.0]])


def building(
    texture: tuple[str, int] | None = None, height_m: float = 12.0
) -> Building:
    walls = tuple(
        Wall(
            start_m=tuple(FOOTPRINT[edge].tolist()),
            end_m=tuple(FOOTPRINT[(edge + 1) % 4].tolist()),
            front_id="f" if edge == 0 else None,
            texture=texture if edge == 0 else None,
            evidence=None if edge == 0 and texture else evidence.ASSUMED,
        )
        for edge in range(4)
    )
    return Building("1-1", FOOTPRINT, height_m, walls, assumed=texture is None)


def solid(one: Mesh) -> trimesh.Trimesh:
    return trimesh.Trimesh(
        one.positions_m, one.triangles, merge_norm=True, merge_tex=True
    )


def stepped(top: int) -> atlas.Atlas:
    """Draw a front whose upper `top` of 100 rows are there in the middle third only."""
    codes = np.full((100, 90), evidence.PHOTOGRAPHED, np.uint8)
    codes[:top, :30] = codes[:top, 60:] = evidence.NOTHING
    image = np.full((100, 90), 128, np.uint8)
    return atlas.build({("p", 0, None): sample.plain(image, codes)})


def test_a_plain_building_is_watertight_and_as_large_as_its_cuboid() -> None:
    one = solid(mesh.building(building(), stepped(0)))
    assert one.is_watertight
    assert one.is_winding_consistent
    assert one.volume == pytest.approx(10 * 6 * 12)


def test_normals_point_out_and_are_of_unit_length() -> None:
    one = mesh.building(building(), stepped(0))
    np.testing.assert_allclose(np.linalg.norm(one.normals, axis=1), 1, atol=1e-12)
    away = one.positions_m - np.array([5.0, 3.0, 6.0])
    assert ((away * one.normals).sum(axis=1) > 0).all()


def test_the_front_shows_its_tile_upright() -> None:
    sheet = stepped(0)
    one = mesh.building(building(("p", 0)), sheet)
    box, (h, w) = sheet.tiles["p", 0, None], sheet.image.shape
    lower_left, _, upper_right, _ = one.uvs[:4]
    np.testing.assert_allclose(lower_left, [box.x0 / w, box.y1 / h])
    np.testing.assert_allclose(upper_right, [box.x1 / w, box.y0 / h])
    np.testing.assert_allclose(one.positions_m[0], [0, 0, 0])


def test_the_roof_lies_at_the_eaves_of_a_stepped_front() -> None:
    one = mesh.building(building(("p", 0)), stepped(20))
    roof = one.positions_m[(one.normals @ [0.0, 0.0, 1.0]) > 0.9]
    np.testing.assert_allclose(roof[:, 2], 12 * 0.8, atol=0.2)
    assert one.positions_m[:, 2].max() == pytest.approx(12.0)


def test_behind_a_front_with_gaps_stands_a_plain_wall() -> None:
    whole = mesh.building(building(("p", 0)), stepped(0))
    holed = mesh.building(building(("p", 0)), stepped(20))
    assert len(holed.triangles) == len(whole.triangles) + 2


def test_joined_meshes_keep_their_numbers_and_their_triangles() -> None:
    parts = [mesh.building(building(), stepped(0), number=n) for n in range(3)]
    whole = mesh.joined(parts)
    assert sorted(set(whole.features)) == [0, 1, 2]
    assert whole.triangles.max() == len(whole.positions_m) - 1
    np.testing.assert_array_equal(
        whole.positions_m[whole.triangles[-1]],
        parts[2].positions_m[parts[2].triangles[-1]],
    )


def test_a_copy_is_repeated_along_a_longer_wall() -> None:
    image = np.full((120, 50), 128, np.uint8)
    one = sample.plain(image)
    sheet = atlas.build({("p", 0, evidence.COPIED): one})
    plain = building()
    copy = replace(plain.walls[0], texture=("p", 0), evidence=evidence.COPIED)
    copied = replace(plain, walls=(copy, *plain.walls[1:]))
    made = mesh.building(copied, sheet)
    fronts = made.positions_m[np.abs(made.normals[:, 1] + 1) < 1e-9]
    np.testing.assert_allclose(np.unique(fronts[:, 0]), [0, 5, 10])
