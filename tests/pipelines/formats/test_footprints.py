"""Footprints lie where the buildings stand, with their heights and evidence."""

import json
from pathlib import Path

import numpy as np
import pytest
import shapely
from pyproj import Geod

from nostalgin_core import evidence, formats, rests
from tests.pipelines.formats.readers import told
from tests.pipelines.formats.shown_city import Json, glb, site_record


def features(out: Path) -> list[Json]:
    return json.loads((out / "geojson/footprints.geojson").read_text())["features"]


GDAL = """
import json, sys
import pyogrio.raw
meta, _, shapes, fields = pyogrio.raw.read(sys.argv[1])[:4]
names = list(meta["fields"])
print(json.dumps({"crs": meta["crs"], "count": len(shapes),
    "heights": [float(v) for v in fields[names.index("height_m")]]}))
"""


def test_gdal_reads_the_footprints_with_their_heights(globe: Path, out: Path) -> None:
    read = told("pyogrio", GDAL, str(out / "geojson/footprints.geojson"))
    assert read["crs"] == "EPSG:4326"
    shown = [
        mesh
        for block in "12"
        for name, mesh in glb(globe, block).geometry.items()
        if name != f"{block}-ground"  # the yards: of no building
    ]
    heights = sorted(float(mesh.bounds[1, 1]) for mesh in shown)
    assert sorted(read["heights"]) == pytest.approx(heights, abs=2e-3)
    assert read["count"] == len(shown)


def test_footprints_are_anticlockwise_and_as_large_as_on_the_ground(
    globe: Path, out: Path
) -> None:
    ellipsoid = Geod(ellps="WGS84")
    for one in features(out):
        polygon = shapely.geometry.shape(one["geometry"])
        assert polygon.is_valid
        assert polygon.exterior.is_ccw
        area, _ = ellipsoid.geometry_area_perimeter(polygon)
        block = one["properties"]["block"]
        mesh = glb(globe, block).geometry[one["id"]]
        floor = mesh.face_normals[:, 1] < -0.5
        assert area == pytest.approx(mesh.area_faces[floor].sum(), rel=2e-3)


def test_evidence_shares_are_those_of_the_texels(globe: Path, out: Path) -> None:
    """Count the texels again, by another reader's coordinates."""
    shown = glb(globe, "1")
    (one,) = (o for o in site_record(globe)["blocks"] if o["name"] == "1")
    codes = formats.read((globe / "site" / one["uri"]).read_bytes()).evidence
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
