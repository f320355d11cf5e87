import json
from typing import Any

import numpy as np
import pytest
import shapely
from pyproj import Transformer

from nostalgin_core.city import Anchor
from pipelines.index import outlines
from pipelines.index.geojson import NoOutlines, features

CORNER = (-73.986, 40.7555)
BLOCKS = ["993", "996"]


def square(east: int, north: int = 0) -> list[list[float]]:
    """Give a ring of about 80 by 110 metres, so many streets away from the corner."""
    x, y = CORNER[0] + 0.0015 * east, CORNER[1] + 0.0015 * north
    return [[x, y], [x + 0.001, y], [x + 0.001, y + 0.001], [x, y + 0.001], [x, y]]


def feature(ring: list[list[float]], **properties: Any) -> dict[str, Any]:
    geometry = {"type": "Polygon", "coordinates": [ring]}
    return {"type": "Feature", "properties": properties, "geometry": geometry}


def collection(*every: dict[str, Any], **more: Any) -> bytes:
    told = {"type": "FeatureCollection", "features": every, **more}
    return json.dumps(told).encode()


TWO = collection(feature(square(0), block="993"), feature(square(1), block=996))


def test_each_block_gets_its_outline() -> None:
    anchors, told = outlines.read(TWO, BLOCKS)
    assert list(anchors) == BLOCKS
    assert told == []
    (part,) = anchors["993"].outline_deg
    assert shapely.Polygon(part).equals_exact(
        shapely.Polygon(square(0)), 1e-6, normalize=True
    )


def test_what_is_written_reads_back_the_same() -> None:
    anchors, _ = outlines.read(TWO, BLOCKS)
    data = outlines.written(anchors, "two.geojson")
    again, told = outlines.read(data, BLOCKS)
    assert told == []
    for block, one in anchors.items():
        old, new = map(
            shapely.Polygon, (one.outline_deg[0], again[block].outline_deg[0])
        )
        assert old.symmetric_difference(new).area < 1e-6 * old.area


@pytest.mark.parametrize(
    ("name", "value"),
    [("Block", "00993"), ("BLOCK", 993), ("block", 993.0), ("BBL", "1009930001")],
)
def test_a_block_is_named_in_many_ways(name: str, value: object) -> None:
    data = collection(feature(square(0), **{name: value}))
    assert list(outlines.read(data, BLOCKS)[0]) == ["993"]


def test_feet_with_their_system_are_degrees() -> None:
    to_feet = Transformer.from_crs("EPSG:4326", "EPSG:2263", always_xy=True)
    ring = [list(to_feet.transform(*one)) for one in square(0)]
    data = collection(feature(ring, block="993"))
    anchors, _ = outlines.read(data, BLOCKS, crs="EPSG:2263")
    there = np.array([anchors["993"].longitude_deg, anchors["993"].latitude_deg])
    assert np.allclose(there, np.array(CORNER) + 0.0005, atol=1e-6)
    crs = {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::2263"}}
    named, _ = outlines.read(collection(feature(ring, block="993"), crs=crs), BLOCKS)
    assert named["993"].longitude_deg == anchors["993"].longitude_deg


def test_cityjson_is_read_with_its_own_system() -> None:
    to_rd = Transformer.from_crs("EPSG:4326", "EPSG:28992", always_xy=True)
    corner = np.array(to_rd.transform(4.89, 52.37))
    flat = np.array([[0, 0, 0], [90, 0, 0], [90, 60, 0], [0, 60, 0]])
    high = flat + np.array([0, 0, 12])
    walls = [[[0, 1, 5, 4]], [[1, 2, 6, 5]]]
    solid = {"type": "Solid", "boundaries": [[[[0, 3, 2, 1]], [[4, 5, 6, 7]], *walls]]}
    told = {
        "type": "CityJSON",
        "version": "2.0",
        "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/28992"},
        "transform": {"scale": [0.5, 0.5, 0.5], "translate": [*corner, 0]},
        "vertices": (2 * np.concatenate([flat, high])).tolist(),
        "CityObjects": {
            "a": {"type": "Building", "attributes": {"block": 993}},
            "b": {"type": "BuildingPart", "parents": ["a"], "geometry": [solid]},
        },
    }
    anchors, _ = outlines.read(json.dumps(told).encode(), BLOCKS)
    back = Transformer.from_crs("EPSG:4326", "EPSG:28992", always_xy=True)
    ring = np.column_stack(back.transform(*anchors["993"].outline_deg[0].T))
    assert shapely.Polygon(ring).area == pytest.approx(90 * 60, rel=0.01)


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "empty"),
        (b"not json", "no JSON"),
        (b"[" * 100_000, "no JSON"),
        (b"[1, 2]", "neither a GeoJSON"),
        (b'{"type": "Topology"}', "neither a GeoJSON"),
        (b'{"type": "FeatureCollection"}', "breaks the rules"),
        (b'{"type": "FeatureCollection", "features": []}', "no feature"),
        (b'{"type": "CityJSON"}', "breaks the rules"),
        (collection(feature([[0, 0], [1, 1]], block="993")), "no polygon"),
        (collection({"type": "Feature", "geometry": None}), "no polygon"),
        (collection(feature(square(0), name="x")), "--outline-key"),
        (collection(feature(square(0), block="7")), "another city"),
        (
            collection(
                feature([[9e5, 2e5], [9.1e5, 2e5], [9.1e5, 2.1e5]], block="993")
            ),
            "feet",
        ),
    ],
)
def test_a_useless_file_names_its_fault_and_the_remedy(data: bytes, words: str) -> None:
    with pytest.raises(NoOutlines, match=words):
        outlines.read(data, BLOCKS)


def test_a_system_that_is_none_is_named() -> None:
    with pytest.raises(NoOutlines, match="EPSG:2263"):
        outlines.read(TWO, BLOCKS, crs="EPSG:1")


def test_an_outline_that_crosses_itself_is_mended_and_told() -> None:
    bow = square(0)
    bow[1], bow[2] = bow[2], bow[1]
    anchors, told = outlines.read(
        collection(feature(bow, block="993"), feature(square(1), block="996")), BLOCKS
    )
    assert list(anchors) == BLOCKS
    assert told == ["feature 1 crosses itself; it was mended"]


def test_two_blocks_with_one_outline_get_none_and_the_others_theirs() -> None:
    data = collection(
        feature(square(0), block="993"),
        feature(square(0), block="996"),
        feature(square(3), block="997"),
    )
    anchors, told = outlines.read(data, ["993", "996", "997"])
    assert list(anchors) == ["997"]
    assert "features 1 and 2" in told[0]


def test_one_bad_feature_spoils_no_other() -> None:
    bad = [
        feature([[0, float("nan")], [1, 1], [1, 0]], block="993"),
        feature([[500, 0], [501, 1], [501, 0]], block="993"),
        {"type": "Feature", "geometry": {"type": "Polygon"}},
        "no feature",
    ]
    anchors, told = outlines.read(
        collection(*bad, feature(square(0), block="993")), BLOCKS
    )  # pyright: ignore[reportArgumentType]
    assert list(anchors) == ["993"]
    assert [one.split()[1] for one in told] == ["1", "2", "3", "4"]


def test_features_keep_their_numbers() -> None:
    assert [one.number for one in features(TWO)] == [1, 2]


def inside(east: float, north: float = 0.0) -> Anchor:
    """Give a point in the middle of a square."""
    x, y = (0.0015 * one + 0.0005 for one in (east, north))
    return Anchor(CORNER[0] + x, CORNER[1] + y)


def halves(east: int) -> list[dict[str, Any]]:
    """Cut a square into two buildings that touch."""
    (x0, y0), (x1, y1) = square(east)[0], square(east)[2]
    middle = (x0 + x1) / 2
    return [
        feature([[a, y0], [b, y0], [b, y1], [a, y1], [a, y0]], name="a house")
        for a, b in ((x0, middle), (middle, x1))
    ]


def test_outlines_that_name_no_block_go_to_whose_point_lies_among_them() -> None:
    data = collection(*halves(0), *halves(1), *halves(2))
    points = {"00993": inside(0), "996": inside(2.05)}
    anchors, told = outlines.read(data, BLOCKS, points=points)
    assert told == []
    for block, east in (("993", 0), ("996", 2)):
        (part,) = anchors[block].outline_deg
        wanted = shapely.Polygon(square(east))
        assert shapely.Polygon(part).symmetric_difference(wanted).area < 0.01 * (
            wanted.area
        )


def test_a_key_goes_before_points() -> None:
    points = {"993": inside(1), "996": inside(0)}
    assert outlines.read(TWO, BLOCKS, points=points)[0].keys() == {"993", "996"}
    west = outlines.read(TWO, BLOCKS, points=points)[0]["993"].longitude_deg
    assert west == pytest.approx(CORNER[0] + 0.0005)


def test_points_of_another_city_get_no_outline_and_are_told() -> None:
    with pytest.raises(NoOutlines, match="another city"):
        outlines.read(collection(*halves(0)), BLOCKS, points={"993": inside(900)})
