from pathlib import Path

import numpy as np
import pytest

from nostalgin_core.records import Box, Photo
from pipelines.evaluate import detectors, rectification, search_space
from tests.data import DATA
from tests.painted_front import photograph


def test_a_label_becomes_masks_without_occluders_and_groups() -> None:
    square = [[10, 10], [50, 10], [50, 90], [10, 90]]
    label = {
        "objects": [
            {"category": "facade", "polygon": square, "target": True},
            {"category": "facade", "polygon": square, "group": True},
            {"category": "vehicle", "polygon": [[0, 70], [60, 70], [60, 95], [0, 95]]},
        ]
    }
    image = Photo("0" * 16, np.zeros((100, 80), np.uint8), Box(0, 0, 80, 100))
    fronts, matted = rectification.matted_from(label, image)
    assert len(fronts) == len(matted.facades) == 1
    (facade,) = matted.facades
    assert facade.target
    assert facade.amodal[80, 30]
    assert not facade.alpha[80, 30]
    assert facade.alpha[40, 30] == 1
    assert [one.category for one in matted.occluders] == ["vehicle"]


@pytest.mark.parametrize("detect", [detectors.lsd, detectors.hough])
def test_other_detectors_find_a_painted_fronts_lines(detect: object) -> None:
    assert callable(detect)
    image = photograph().photo.image
    strict, loose = detect(image, (16, 4.0), (8, 9.0))
    assert len(loose) > 30
    np.testing.assert_array_equal(strict, loose)
    (nothing,) = detect(np.full((60, 60), 90, np.uint8), (8, 9.0))
    assert nothing.shape == (0, 4)


def test_deduplication_shrinks_the_search() -> None:
    found = search_space.reductions(photograph().photo.image)
    assert found["both"][0] >= max(found["collinear lines"][0] - 1e-9, 1)
    assert found["infinite points"][0] >= 0
    assert all(moved < 2 for _, _, moved in found.values())


@pytest.mark.skipif(
    not (DATA / "york_urban").is_dir(), reason=f"no York Urban images at {DATA}"
)
def test_two_images_of_york_urban_are_evaluated(tmp_path: Path) -> None:
    for name in ("cameraParameters.mat", "P1030001", "P1080032"):
        (tmp_path / name).symlink_to(DATA / "york_urban" / name)
    report = rectification.york_urban(tmp_path)
    assert report["images"] == 2
    assert report["median_deg"] < 3
    assert 50 < report["horizon_auc"] <= 100
