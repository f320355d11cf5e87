import numpy as np
import pytest

from nostalgin_core.rectify import lines
from pipelines.evaluate import detectors
from tests.painted_front import photograph


@pytest.mark.parametrize("detect", [detectors.lsd, detectors.hough])
def test_other_detectors_find_a_painted_fronts_lines(detect: lines.Detector) -> None:
    image = photograph().photo.image
    strict, loose = detect(image, (16, 4.0), (8, 9.0))
    assert len(loose) > 30
    np.testing.assert_array_equal(strict, loose)
    (nothing,) = detect(np.full((60, 60), 90, np.uint8), (8, 9.0))
    assert nothing.shape == (0, 4)


@pytest.mark.parametrize("detect", [lines.detect, detectors.lsd, detectors.hough])
def test_no_detector_finds_a_line_wholly_outside_the_mask(
    detect: lines.Detector,
) -> None:
    image = photograph().photo.image
    where = np.zeros(image.shape, bool)
    where[:, :300] = True
    (found,) = detect(image, (8, 9.0), where=where)
    assert len(found) > 10
    assert found[:, [0, 2]].min(axis=1).max() <= 300
