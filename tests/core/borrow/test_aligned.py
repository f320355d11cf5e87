"""A rough overlay is made exact, and one that is far off is not taken for rough."""

import cv2
import numpy as np
import pytest

from nostalgin_core.borrow.aligned import WIDEST, aligned, moved
from nostalgin_core.views import View
from tests.core.views.test_views import front, whole

H, W = 420, 300
MIDDLE = np.s_[115:305, 60:240]


def grown(by: float) -> np.ndarray:
    """Grow an elevation about its middle."""
    return np.array([[by, 0, (1 - by) * W / 2], [0, by, (1 - by) * H / 2], [0, 0, 1.0]])


def only_middle() -> View:
    known = np.zeros((H, W), bool)
    known[MIDDLE] = True
    return View(front(1), known)


@pytest.mark.parametrize("by", [0.95, 1.0, 1.06])
def test_a_rough_overlay_is_made_exact(by: float) -> None:
    found = aligned(only_middle(), whole(front(1)), grown(by))
    assert found is not None
    corners = np.array([[[0.0, 0], [W, 0], [W, H], [0, H]]])
    off = cv2.perspectiveTransform(corners, found.matrix) - corners
    assert np.abs(off).max() < 2.0


@pytest.mark.parametrize("by", [0.88, 1.13])
def test_corrections_are_measured_together_against_the_rough_overlay(by: float) -> None:
    assert moved(grown(by), (H, W)) > WIDEST * H
    assert aligned(only_middle(), whole(front(1)), grown(by)) is None
