"""The plain loop on a painted photo; that the pipeline equals it: tests/pipelines."""

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from nostalgin_core import evidence, reconstruct, steps
from nostalgin_core.records import Front
from nostalgin_core.steps import Networks
from pipelines.models import Models
from tests.pipelines import painted

WIDTH_M = 14.0  # so that its painted storeys are as high as storeys are
FRONTS = [
    Front("5-1-0", "5", "1", 0, 0, 0, "Elm Street", "1", WIDTH_M, None, False),  # noqa: FBT003
    Front("5-2-0", "5", "2", 0, 0, 1, "Elm Street", "3", 8.0, None, False),  # noqa: FBT003
]


@pytest.fixture(scope="module")
def networks(tmp_path_factory: pytest.TempPathFactory) -> Networks:
    return painted.networks(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def rebuilt(networks: Networks) -> reconstruct.Rebuilt:
    photos = {"a.png": (painted.photo(0), ["5-1-0"])}
    return reconstruct.rebuild("5", FRONTS, photos, networks)


def test_the_photographed_lot_wears_its_photo_and_the_other_is_assumed(
    rebuilt: reconstruct.Rebuilt,
) -> None:
    first, second = rebuilt.settled.block.buildings
    assert (first.building_id, first.assumed) == ("5-1", False)
    assert (second.building_id, second.assumed) == ("5-2", True)
    assert [w.texture is not None for w in first.walls].count(True) == 1
    assert {w.evidence for w in second.walls} == {evidence.ASSUMED}


def test_a_wall_has_the_proportions_of_the_facade_it_wears(
    rebuilt: reconstruct.Rebuilt, networks: Networks
) -> None:
    made = steps.photograph(painted.photo(0), networks, name="a.png")
    ((_, facade),) = rebuilt.settled.worn()
    aspect = next(one.aspect for one in made.elevations if one.facade == facade)
    building = rebuilt.settled.block.buildings[0]
    assert building.height is not None
    assert building.height.by_width_m == pytest.approx(WIDTH_M / aspect)
    assert building.height_m == pytest.approx(WIDTH_M / aspect, rel=0.15)
    assert building.height.low_m < WIDTH_M / aspect < building.height.high_m


def test_the_model_is_a_glb_that_names_its_buildings(
    rebuilt: reconstruct.Rebuilt,
) -> None:
    magic, version, length = struct.unpack("<4sII", rebuilt.glb[:12])
    assert (magic, version, length) == (b"glTF", 2, len(rebuilt.glb))
    size = struct.unpack("<I", rebuilt.glb[12:16])[0]
    names = [node["name"] for node in json.loads(rebuilt.glb[20 : 20 + size])["nodes"]]
    assert {"5-1", "5-2"} <= set(names)


def test_rebuilding_gives_the_same_bytes(
    rebuilt: reconstruct.Rebuilt, networks: Networks
) -> None:
    photos = {"a.png": (painted.photo(0), ["5-1-0"])}
    assert reconstruct.rebuild("5", FRONTS, photos, networks).glb == rebuilt.glb


def test_a_photo_that_can_not_be_read_leaves_its_lot_assumed(
    networks: Networks,
) -> None:
    photos = {"a.png": (b"no photo", ["5-1-0"])}
    rebuilt = reconstruct.rebuild("5", FRONTS, photos, networks)
    assert [one.stage for one in rebuilt.rejections] == ["photo"]
    assert all(building.assumed for building in rebuilt.settled.block.buildings)


def test_a_stage_that_declines_ends_the_steps(networks: Networks) -> None:
    def nothing(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        *things, pixels, indoors = networks.segment(gray)
        return (*(one[:0] for one in things), pixels, indoors)

    blind = Networks(nothing, networks.inpaint)
    words = [stage for stage, _ in steps.steps(painted.photo(0), blind, name="a")]
    assert words == ["photo", "segment"]


def test_what_the_camera_saw_reaches_the_end_untouched(networks: Networks) -> None:
    made = steps.photograph(painted.photo(0), networks, name="a.png")
    assert made.elevations
    for before, after in zip(made.rectified, made.elevations, strict=True):
        seen = before.evidence == evidence.PHOTOGRAPHED
        assert seen.any()
        assert np.array_equal(before.image[seen], after.image[seen])
        changed = before.evidence != after.evidence
        was, became = before.evidence[changed], after.evidence[changed]
        assert set(zip(was.tolist(), became.tolist(), strict=True)) <= {
            (evidence.SOFT_EDGE, evidence.INPAINTED),
            (evidence.SOFT_EDGE, evidence.COPIED),
            (evidence.INPAINTED, evidence.COPIED),
        }


def test_the_painted_networks_are_locked(tmp_path: Path) -> None:
    folder = painted.write_models(tmp_path, segment=painted.segment_network())
    assert Models(str(folder)).sha256("segment")
