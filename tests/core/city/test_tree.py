"""Laws of the tree of tiles: all in its place, bounded, honest, the same twice."""

import hashlib
import io
import json
import struct
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import trimesh

from nostalgin_core.city.groups import MOST, grouped, packed
from nostalgin_core.city.tileset import ERROR_OF_TEXEL, Place, Tile, carried
from nostalgin_core.city.tree import INLINE, Tree, tree
from nostalgin_core.city.volumes import lump
from tests.core.city.test_tileset import corners, matrix, outside

MIDTOWN = Place(-73.9868, 40.7549, 12.0)
Json = dict[str, Any]


def blocks(count: int) -> list[Tile]:
    """Lay out blocks in streets and avenues, each turned by a little."""
    rng = np.random.default_rng(count)
    across = int(np.ceil(np.sqrt(count)))
    made = []
    for n in range(count):
        widths = rng.uniform(5, 12, 6)
        starts = np.cumsum([0.0, *widths[:-1]])
        grounds = [
            [[x, 0.0], [x + w, 0.0], [x + w, 18.0], [x, 18.0]]
            for x, w in zip(starts, widths, strict=True)
        ]
        heights = rng.uniform(8, 40, 6)
        made.append(
            Tile(
                f"blocks/{n}.glb",
                (0.0, 0.0, 0.0),
                (float(widths.sum()), 18.0, float(heights.max())),
                origin_m=(120.0 * (n % across), 60.0 * (n // across)),
                turn_rad=0.02 * n,
                coarse_uri=f"far/{n}.glb",
                coarse_texel_m=0.25,
                footprints_m=np.array(grounds),
                heights_m=heights,
            )
        )
    return made


def documents(made: Tree) -> dict[str, Json]:
    """Read every tileset of a city, the root's as tileset.json."""
    others = {
        name: json.loads(make())
        for name, make in made.files.items()
        if name.endswith(".json")
    }
    return {"tileset.json": made.tileset, **others}


def walked(
    made: Tree, tile: Json | None = None, parent: np.ndarray | None = None
) -> Iterator[tuple[Json, np.ndarray]]:
    """Visit every tile with its frame, through all files."""
    tile = made.tileset["root"] if tile is None else tile
    frame = (np.eye(4) if parent is None else parent) @ matrix(tile)
    uri = tile.get("content", {}).get("uri", "")
    if uri.endswith(".json"):
        yield from walked(made, json.loads(made.files[uri]())["root"], frame)
        return
    yield tile, frame
    for child in tile.get("children", ()):
        yield from walked(made, child, frame)


@pytest.mark.parametrize("count", [1, 16, 17, 300])
def test_every_block_is_in_the_tree_once_and_in_its_frame(count: int) -> None:
    tiles = blocks(count)
    made = tree(tiles)
    found: dict[str, np.ndarray] = {}
    for tile, frame in walked(made):
        uri = tile.get("content", {}).get("uri", "")
        if uri.startswith("blocks/"):
            assert uri not in found
            found[uri] = frame
    assert found.keys() == {one.uri for one in tiles}
    for one, frame in zip(tiles, made.frames, strict=True):
        np.testing.assert_allclose(found[one.uri], np.reshape(frame, (4, 4)).T)


@pytest.mark.parametrize("count", [1, 17, 300])
def test_no_tile_has_more_than_sixteen_children_and_no_file_more_than_some(
    count: int,
) -> None:
    made = tree(blocks(count))
    for tile, _ in walked(made):
        assert len(tile.get("children", ())) <= MOST
    for told in documents(made).values():
        assert len(json.dumps(told)) < 64_000 or count <= INLINE


@pytest.mark.parametrize("count", [17, 300])
def test_an_error_is_never_smaller_than_that_of_what_lies_below(count: int) -> None:
    made = tree(blocks(count))

    def check(tile: Json) -> None:
        for child in tile.get("children", ()):
            assert child["geometricError"] <= tile["geometricError"]
            check(child)

    for told in documents(made).values():
        assert told["root"]["geometricError"] <= told["geometricError"]
        check(told["root"])


@pytest.mark.parametrize(("count", "place"), [(17, None), (300, None), (40, MIDTOWN)])
def test_what_a_tile_shows_lies_inside_it(count: int, place: Place | None) -> None:
    made = tree(blocks(count), place=place)

    def check(tile: Json, parent: Json | None) -> None:
        if parent is not None:
            inside = carried(matrix(tile), corners(tile))
            assert outside(inside, parent) <= 1e-6
        uri = tile.get("content", {}).get("uri", "")
        if uri in made.files and uri.endswith(".glb"):
            mesh = trimesh.load(io.BytesIO(made.files[uri]()), file_type="glb")
            east, up, south = mesh.to_geometry().vertices.T
            points = np.column_stack([east, -south, up])
            assert outside(points, tile) <= 0
        for child in tile.get("children", ()):
            check(child, tile)

    for told in documents(made).values():
        check(told["root"], None)


def test_a_district_draws_each_building_with_its_ground_and_height() -> None:
    tiles = blocks(17)
    made = tree(tiles)
    volume = 0.0
    for name, make in made.files.items():
        assert name.startswith("far/")
        mesh = trimesh.load(io.BytesIO(make()), file_type="glb").to_geometry()
        volume += raised(mesh)
    truth = sum(
        float(np.ptp(ground[:, 0]) * np.ptp(ground[:, 1]) * height)
        for one in tiles
        for ground, height in zip(one.footprints_m, one.heights_m, strict=True)
    )
    assert volume == pytest.approx(truth, rel=1e-4)


def raised(mesh: trimesh.Trimesh) -> float:
    """Add up what lies under the roofs."""
    roofs = mesh.face_normals[:, 1] > 0.5
    triangles = mesh.triangles[roofs]
    return float((mesh.area_faces[roofs] * triangles[:, :, 1].mean(axis=1)).sum())


def test_files_are_named_by_what_is_in_them() -> None:
    made = tree(blocks(300))
    assert made.files
    for name, make in made.files.items():
        assert hashlib.sha256(make()).hexdigest()[:16] in name


def test_the_same_city_gives_the_same_bytes() -> None:
    one, two = tree(blocks(300)), tree(blocks(300))
    assert json.dumps(one.tileset) == json.dumps(two.tileset)
    assert {n: make() for n, make in one.files.items()} == {
        n: make() for n, make in two.files.items()
    }


def test_a_small_city_needs_no_districts() -> None:
    made = tree(blocks(16))
    assert made.files == {}
    assert len(made.tileset["root"]["children"]) == 16


def test_a_coarse_tile_s_error_is_four_texels_and_the_fine_one_replaces_it() -> None:
    (tile,) = tree(blocks(1)).tileset["root"]["children"]
    assert tile["geometricError"] == pytest.approx(ERROR_OF_TEXEL * 0.25)
    assert tile["refine"] == "REPLACE"
    (fine,) = tile["children"]
    assert (fine["content"]["uri"], fine["geometricError"]) == ("blocks/0.glb", 0.0)


def test_a_lump_of_one_building_is_not_wrong_and_of_unlike_ones_is() -> None:
    (one,) = blocks(1)
    ground = np.array([[[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]]])
    single = Tile(
        "a", one.low_m, one.high_m, footprints_m=ground, heights_m=np.array([12.0])
    )
    assert lump(single, np.eye(4)).wrong_m == pytest.approx(0.0, abs=1e-6)
    both = np.concatenate([ground, ground + np.array([20.0, 0.0])])
    two = Tile(
        "a", one.low_m, one.high_m, footprints_m=both, heights_m=np.array([12.0, 30.0])
    )
    made = lump(two, np.eye(4))
    assert made.height_m == pytest.approx(21.0)
    assert made.wrong_m == pytest.approx(9.0)  # and the gap is a square of 8.9 metres


def test_a_massing_says_that_nothing_of_it_is_a_photograph() -> None:
    for make in tree(blocks(17)).files.values():
        data = make()
        (length,) = struct.unpack_from("<I", data, 12)
        asset = json.loads(data[20 : 20 + length])["asset"]
        assert asset["extras"]["evidence"] == "assumed"


@pytest.mark.parametrize("count", [1, 5, 100, 1000])
def test_packs_are_whole_full_and_of_neighbours(count: int) -> None:
    points = np.random.default_rng(count).uniform(0, 1000, (count, 2))
    packs = packed(points, most=MOST)
    assert sorted(n for pack in packs for n in pack) == list(range(count))
    assert max(map(len, packs)) <= MOST
    spans = [np.ptp(points[pack], axis=0).max() for pack in packs]
    if count == 1000:
        assert np.mean(spans) < 1000 / 4


def test_blocks_at_one_place_are_grouped_too() -> None:
    group = grouped(np.zeros((50, 2)))
    assert sorted(group.all_blocks()) == list(range(50))
    assert group.level == 2
