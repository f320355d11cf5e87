"""CityJSON is what is shown, and programs that we did not write read it."""

import subprocess
from pathlib import Path

import numpy as np
import pytest
import shapely

from tests.pipelines.formats.readers import CJVAL, told
from tests.pipelines.formats.shown_city import glb, lines


def test_cityjson_has_the_glb_s_corners_in_metres_of_utm(
    globe: Path, out: Path
) -> None:
    first, *others = lines(out, "1")
    assert first["metadata"]["referenceSystem"].endswith("/EPSG/0/32618")
    ids = {one["id"] for one in others}
    shown = glb(globe, "1")
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
    for one in lines(out, "1")[1:-1]:
        (building,) = one["CityObjects"].values()
        assert building["type"] == "Building"
        solid, shown = building["geometry"]
        assert (solid["type"], solid["lod"]) == ("Solid", "1.2")
        assert (shown["type"], shown["lod"]) == ("MultiSurface", "2.0")
        kinds = [each["type"] for each in shown["semantics"]["surfaces"]]
        found = {kinds[value] for value in shown["semantics"]["values"]}
        assert found == {"WallSurface", "RoofSurface", "GroundSurface"}
        assert set(shown["texture"]) == {"photograph", "evidence"}
        for image in one["appearance"]["textures"]:
            assert (out / "cityjson" / image["image"]).is_file()


def test_a_block_s_yards_are_land_that_nobody_photographed(
    globe: Path, out: Path
) -> None:
    (yards,) = lines(out, "1")[-1]["CityObjects"].values()
    assert yards["type"] == "LandUse"
    assert yards["attributes"]["evidence_assumed"] == 1.0
    (surface,) = yards["geometry"]
    mesh = glb(globe, "1").geometry["1-ground"]
    assert len(surface["boundaries"]) <= len(mesh.faces)
    scale = lines(out, "1")[0]["transform"]["scale"]
    points = np.array(lines(out, "1")[-1]["vertices"]) * scale
    flat = shapely.union_all(
        [shapely.Polygon(points[ring, :2]) for (ring,) in surface["boundaries"]]
    )
    assert shapely.area(flat) == pytest.approx(mesh.area, rel=3e-3)  # UTM's own scale


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
    assert f"invalid:  {count - 2}/{count}" in done.stdout.decode()


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
