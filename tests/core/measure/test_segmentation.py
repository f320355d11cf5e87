import numpy as np
import pytest

from nostalgin_core.measure.segmentation import agreement, overlap

TRUE = np.zeros((20, 20), bool)
TRUE[5:15, 5:15] = True
ALL = np.ones_like(TRUE)


def test_the_truth_agrees_with_itself() -> None:
    assert agreement(TRUE.astype(float), TRUE, ALL, threshold=0.5) == (1, 1, 0, 0)


def test_half_the_truth_is_precise_and_recalls_half() -> None:
    half = TRUE.copy()
    half[:, 10:] = False
    measured = agreement(half.astype(float), TRUE, ALL, threshold=0.5)
    assert measured == pytest.approx((1, 0.5, 12.5, 12.5))


def test_soft_errors_count_squared_in_l2() -> None:
    soft = np.where(TRUE, 0.9, 0.1)
    measured = agreement(soft, TRUE, ALL, threshold=0.5)
    assert measured == pytest.approx((1, 1, 10, 1))


def test_pixels_that_do_not_count_change_nothing() -> None:
    counted = ~np.roll(TRUE, 8, axis=1) | TRUE
    wild = TRUE.astype(float)
    wild[~counted] = 1
    assert agreement(wild, TRUE, counted, threshold=0.5) == (1, 1, 0, 0)


def test_nothing_claimed_of_nothing_true_is_right() -> None:
    nothing = np.zeros_like(TRUE)
    assert agreement(nothing.astype(float), nothing, ALL, threshold=0.5)[:2] == (1, 1)


def test_overlap_is_symmetric_and_between_0_and_1() -> None:
    moved = np.roll(TRUE, 5, axis=0)
    assert overlap(TRUE, TRUE) == 1
    assert overlap(TRUE, ~TRUE) == 0
    assert overlap(TRUE, moved) == overlap(moved, TRUE) == pytest.approx(1 / 3)
    assert overlap(TRUE & ~TRUE, TRUE & ~TRUE) == 0
