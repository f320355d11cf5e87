"""What is exported equals what is shown, and programs we did not write read it."""

import io
import json
import subprocess
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import shapely
import trimesh
from PIL import Image
from pyproj import Geod
from scipy.spatial import cKDTree

from nostalgin_core import evidence, formats, rests
from pipelines.formats import Unexportable, export
from pipelines.site import Foreign
from tests.core import sample_block
from tests.pipelines.formats import shown_city
from tests.pipelines.formats.readers import CJVAL, told

Json = dict[str, Any]
BASE = "https://archive.example/city"


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Publish two painted blocks on the globe."""
    folder = tmp_path_factory.mktemp("globe")
    one, two = (shown_city.block_model(n, (0.0, 90.0 * int(n))) for n in "12")
    return shown_city.published(folder, one, two, place=shown_city.MIDTOWN)


@pytest.fixture(scope="module")
def out(city: Path) -> Path:
    folder = city.parent / "out"
    export(city, folder, ("cityjson", "obj", "geojson", "iiif"), base=BASE)
    return folder


def lines(out: Path, block: str) -> list[Json]:
    path = out / "cityjson" / f"{block}.city.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()]


def site_record(city: Path) -> Json:
    return json.loads((city / "site/site.json").read_text())


def glb(city: Path, block: str) -> trimesh.Scene:
    (one,) = (o for o in site_record(city)["blocks"] if o["name"] == block)
    data = (city / "site" / one["uri"]).read_bytes()
    return trimesh.load(io.BytesIO(data), file_type="glb")


def unzipped(out: Path, folder: Path, block: str) -> Path:
    with zipfile.ZipFile(out / "obj" / f"{block}.zip") as file:
        file.extractall(folder)
    return folder


def features(out: Path) -> list[Json]:
    return json.loads((out / "geojson/footprints.geojson").read_text())["features"]


def tree(folder: Path) -> dict[str, bytes]:
    return {
        str(one.relative_to(folder)): one.read_bytes()
        for one in sorted(folder.rglob("*"))
        if one.is_file()
    }


def test_an_obj_has_the_glb_s_triangles_and_area(
    city: Path, out: Path, tmp_path: Path
) -> None:
    unzipped(out, tmp_path, "1")
    assert [one.name for one in tmp_path.glob("*.obj")] == ["1.obj"]
    assert [one.name for one in tmp_path.glob("*.mtl")] == ["1.mtl"]
    obj = trimesh.load_scene(tmp_path / "1.obj", process=False, split_objects=True)
    shown = glb(city, "1")
    named = {name.removesuffix("_photograph"): m for name, m in obj.geometry.items()}
    assert set(named) == set(shown.geometry)
    for name, mesh in shown.geometry.items():
        other = named[name]
        assert other.area == pytest.approx(mesh.area, rel=1e-4)
        np.testing.assert_allclose(other.bounds, mesh.bounds, atol=1e-4)
        assert cKDTree(other.vertices).query(mesh.vertices)[0].max() < 1e-4
        assert cKDTree(mesh.vertices).query(other.vertices)[0].max() < 1e-4


def test_an_obj_wears_the_photographs_the_right_way_up(
    city: Path, out: Path, tmp_path: Path
) -> None:
    unzipped(out, tmp_path, "1")
    obj = trimesh.load(tmp_path / "1.obj", process=False, force="mesh")
    one, two = (
        np.column_stack([mesh.vertices, mesh.visual.uv])
        for mesh in (obj, glb(city, "1").to_geometry())
    )
    assert cKDTree(one).query(two)[0].max() < 1e-3
    assert cKDTree(two).query(one)[0].max() < 1e-3
    sizes = set()
    for name in ("1.png", "1-opacity.png", "1-evidence.png"):
        with Image.open(tmp_path / name) as picture:
            sizes.add(picture.size)
    assert len(sizes) == 1


def test_cityjson_has_the_glb_s_corners_in_metres_of_utm(city: Path, out: Path) -> None:
    first, *others = lines(out, "1")
    assert first["metadata"]["referenceSystem"].endswith("/EPSG/0/32618")
    ids = {one["id"] for one in others}
    shown = glb(city, "1")
    assert ids == set(shown.geometry)
    for one in others:
        points = np.array(one["vertices"]) * first["transform"]["scale"]
        mesh = shown.geometry[one["id"]]
        height = np.ptp(points[:, 2])
        assert height == pytest.approx(np.ptp(mesh.vertices[:, 1]), abs=2e-3)
        spans = (
            shapely.MultiPoint(points[:, :2]).convex_hull.area,
            shapely.MultiPoint(mesh.vertices[:, [0, 2]]).convex_hull.area,
        )
        assert spans[0] == pytest.approx(spans[1], rel=3e-3)  # UTM's own scale


def test_cityjson_names_what_is_wall_roof_and_ground(out: Path) -> None:
    for one in lines(out, "1")[1:]:
        (building,) = one["CityObjects"].values()
        solid, shown = building["geometry"]
        assert (solid["type"], solid["lod"]) == ("Solid", "1.2")
        assert (shown["type"], shown["lod"]) == ("MultiSurface", "2.0")
        kinds = [each["type"] for each in shown["semantics"]["surfaces"]]
        found = {kinds[value] for value in shown["semantics"]["values"]}
        assert found == {"WallSurface", "RoofSurface", "GroundSurface"}
        assert set(shown["texture"]) == {"photograph", "evidence"}
        for image in one["appearance"]["textures"]:
            assert (out / "cityjson" / image["image"]).is_file()


@pytest.mark.skipif(CJVAL is None, reason="no cjval: set NOSTALGIN_CJVAL")
@pytest.mark.parametrize("block", ["1", "2"])
def test_the_official_validator_of_cityjson_finds_no_error(
    out: Path, block: str
) -> None:
    data = (out / "cityjson" / f"{block}.city.jsonl").read_bytes()
    done = subprocess.run(
        [CJVAL or ""], input=data, cwd=out / "cityjson", capture_output=True, check=True
    )
    count = len(lines(out, block))
    assert f"invalid:  0/{count}" in done.stdout.decode()
    assert f"warnings: 0/{count}" in done.stdout.decode()
    spoiled = data.replace(b'"Building"', b'"Castle"')
    done = subprocess.run(
        [CJVAL or ""], input=spoiled, capture_output=True, check=False
    )
    assert f"invalid:  {count - 1}/{count}" in done.stdout.decode()


CJIO = """
import json, sys
from cjio import cityjson
rows = [json.loads(line) for line in open(sys.argv[1], encoding="utf-8")]
model = cityjson.CityJSON(j=rows[0])
for row in rows[1:]:
    model.add_cityjsonfeature(row)
model.remove_duplicate_vertices()
info = model.get_info(long=True)
print(json.dumps({"count": model.number_city_objects_level1(),
    "textures": len(model.j["appearance"]["textures"]),
    "epsg": model.get_epsg()}))
"""


def test_cjio_joins_the_sequence(out: Path) -> None:
    read = told("cjio", CJIO, str(out / "cityjson/1.city.jsonl"))
    assert read["count"] == len(lines(out, "1")) - 1
    assert read["epsg"] == 32618
    assert read["textures"] >= 2


GDAL = """
import json, sys
import pyogrio.raw
meta, _, shapes, fields = pyogrio.raw.read(sys.argv[1])[:4]
names = list(meta["fields"])
print(json.dumps({"crs": meta["crs"], "count": len(shapes),
    "heights": [float(v) for v in fields[names.index("height_m")]]}))
"""


def test_gdal_reads_the_footprints_with_their_heights(city: Path, out: Path) -> None:
    read = told("pyogrio", GDAL, str(out / "geojson/footprints.geojson"))
    assert read["crs"] == "EPSG:4326"
    shown = [m for b in "12" for m in glb(city, b).geometry.values()]
    heights = sorted(float(mesh.bounds[1, 1]) for mesh in shown)
    assert sorted(read["heights"]) == pytest.approx(heights, abs=2e-3)
    assert read["count"] == len(shown)


def test_footprints_are_anticlockwise_and_as_large_as_on_the_ground(
    city: Path, out: Path
) -> None:
    globe = Geod(ellps="WGS84")
    for one in features(out):
        polygon = shapely.geometry.shape(one["geometry"])
        assert polygon.is_valid
        assert polygon.exterior.is_ccw
        area, _ = globe.geometry_area_perimeter(polygon)
        block = one["properties"]["block"]
        mesh = glb(city, block).geometry[one["id"]]
        floor = mesh.face_normals[:, 1] < -0.5
        assert area == pytest.approx(mesh.area_faces[floor].sum(), rel=2e-3)


def test_evidence_shares_are_those_of_the_texels(city: Path, out: Path) -> None:
    """Count the texels again, by another reader's coordinates."""
    shown = glb(city, "1")
    (one,) = (o for o in site_record(city)["blocks"] if o["name"] == "1")
    codes = formats.read((city / "site" / one["uri"]).read_bytes()).evidence
    h, w = codes.shape
    words = ("photographed", "soft_edge", "inpainted", "beyond_frame", "copied")
    for feature in features(out):
        if feature["properties"]["block"] != "1":
            continue
        mesh = shown.geometry[feature["id"]]
        counts = np.zeros(8)
        walls = np.flatnonzero(np.abs(mesh.face_normals[:, 1]) <= 0.5)
        for face in walls:
            u, v = mesh.visual.uv[mesh.faces[face]].T
            xs = np.round([u.min() * w, u.max() * w]).astype(int)
            ys = np.round([(1 - v.max()) * h, (1 - v.min()) * h]).astype(int)
            tile = codes[ys[0] : ys[1], xs[0] : xs[1]]
            share = np.bincount(tile.ravel(), minlength=8) / tile.size
            counts += share * mesh.area_faces[face]
        counts[evidence.NOTHING] = 0
        counts /= counts.sum()
        told_shares = [feature["properties"][f"evidence_{word}"] for word in words]
        np.testing.assert_allclose(told_shares, counts[1:6], atol=2e-4)
        another = feature["properties"]["evidence_another_picture"]
        assert another == pytest.approx(counts[rests.ANOTHER], abs=2e-4)
        whole = sum(told_shares) + another + feature["properties"]["evidence_assumed"]
        assert whole == pytest.approx(1.0, abs=5e-4)


IIIF = """
import json, sys
from iiif_prezi3 import Manifest
made = Manifest(**json.load(open(sys.argv[1], encoding="utf-8")))
again = json.loads(made.json())
print(json.dumps({"type": made.type, "items": len(made.items),
    "first": again["items"][0]["items"][0]["items"][0]["body"]}))
"""


def test_a_iiif_library_reads_the_manifest(city: Path, out: Path) -> None:
    read = told("iiif_prezi3", IIIF, str(out / "iiif/manifest.json"))
    shown = {key for key, _ in sample_block.elevations("1")}
    assert (read["type"], read["items"]) == ("Manifest", len(shown))
    file = read["first"]["id"].removeprefix(f"{BASE}/")
    with Image.open(city / "site" / file) as picture:
        assert picture.size == (read["first"]["width"], read["first"]["height"])


TILES = """
import json, sys
from pathlib import Path
from py3dtiles.tileset import TileSet
made = TileSet.from_file(Path(sys.argv[1]))
uris = []
def walk(tile):
    if tile.content_uri:
        uris.append(str(tile.content_uri))
    for child in tile.children:
        walk(child)
walk(made.root_tile)
print(json.dumps(uris))
"""


def test_py3dtiles_finds_every_block_in_the_tileset(city: Path) -> None:
    uris = told("py3dtiles", TILES, str(city / "site/tileset.json"))
    blocks = site_record(city)["blocks"]
    wanted = {one[name] for one in blocks for name in ("uri", "coarse")}
    assert {uri.removeprefix("./") for uri in uris} == wanted


def test_the_same_city_gives_the_same_bytes(city: Path, out: Path) -> None:
    again = city.parent / "again"
    export(city, again, ("cityjson", "obj", "geojson", "iiif"), base=BASE)
    assert tree(again) == tree(out)


def test_a_caption_of_ten_thousand_letters_survives(out: Path) -> None:
    made = json.loads((out / "iiif/manifest.json").read_text())
    assert made["items"][0]["label"]["none"] == [shown_city.LONG]
    assert len(shown_city.LONG) > 10_000


def test_a_city_without_a_place_has_no_geojson_but_all_else(tmp_path: Path) -> None:
    made = shown_city.published(tmp_path, shown_city.block_model("1", (0.0, 0.0)))
    with pytest.raises(Unexportable, match="no place on the globe"):
        export(made, tmp_path / "out", ("cityjson", "geojson"))
    assert not (tmp_path / "out").exists()
    export(made, tmp_path / "out", ("cityjson", "obj"))
    assert "referenceSystem" not in lines(tmp_path / "out", "1")[0]["metadata"]


@pytest.mark.parametrize(
    ("wanted", "base", "why"),
    [
        (("gml",), "", "choose of"),
        ((), "", "choose of"),
        (("iiif",), "", "--base"),
        (("iiif",), "javascript:alert(1)", "--base"),
        (("prov",), "", "build it again"),
    ],
)
def test_what_can_t_be_told_is_refused_before_anything_is_written(
    city: Path, tmp_path: Path, wanted: tuple[str, ...], base: str, why: str
) -> None:
    with pytest.raises(Unexportable, match=why):
        export(city, tmp_path / "out", wanted, base=base)
    assert not (tmp_path / "out").exists()


def test_a_stranger_s_file_is_not_touched(city: Path, tmp_path: Path) -> None:
    (tmp_path / "obj").mkdir()
    (tmp_path / "obj/1.zip").write_text("mine")
    with pytest.raises(Foreign):
        export(city, tmp_path, ("obj",))
    assert tree(tmp_path) == {"obj/1.zip": b"mine"}


@pytest.mark.parametrize("name", ["../../etc/x", "a\nusemtl b", "שלום", "x" * 300])
def test_a_block_s_name_can_t_lead_out_of_the_folder(name: str, tmp_path: Path) -> None:
    fronts = tuple(
        replace(one, front_id=f"{name}-{one.lot}-{one.side}", block=name)
        for one in sample_block.fronts("1")
    )
    made = shown_city.published(tmp_path, shown_city.bare(name, fronts))
    before = set(tree(tmp_path))
    export(made, tmp_path / "out", ("cityjson", "obj"))
    fresh = set(tree(tmp_path)) - before
    assert all(one.startswith("out/") for one in fresh)
    (archive,) = (tmp_path / "out/obj").glob("*.zip")
    with zipfile.ZipFile(archive) as file:
        (obj,) = (one for one in file.namelist() if one.endswith(".obj"))
        commands = {line.split()[0] for line in file.read(obj).decode().splitlines()}
    assert commands == {"#", "mtllib", "usemtl", "o", "v", "vt", "f"}


@pytest.mark.parametrize("count", [1, 1000])
def test_a_block_of_one_lot_and_of_a_thousand_is_written(
    count: int, tmp_path: Path
) -> None:
    (first, *_) = sample_block.fronts("1")
    fronts = tuple(
        replace(
            first,
            front_id=f"7-{n}-{4 * n // count}",
            block="7",
            lot=str(n),
            side=4 * n // count,
            rank=n,
            street=f"Street {4 * n // count}",
            width_assumed=True,
            width_m=7.62,
        )
        for n in range(count)
    )
    made = shown_city.published(tmp_path, shown_city.bare("7", fronts))
    export(made, tmp_path / "out", ("cityjson", "obj"))
    assert len(lines(tmp_path / "out", "7")) == count + 1
