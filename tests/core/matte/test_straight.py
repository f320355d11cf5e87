"""Painted fronts, and masks of them as ragged as a network's."""

import cv2
import numpy as np
import pytest

from nostalgin_core.matte.straight import fitted, straight
from nostalgin_core.records import Box, Category, Instance, Photo

H, W = 240, 320
FRAME = Box(0, 0, W, H)
ROOF, FOOT = 50, 200


def _painted(*fronts: tuple[int, int, int]) -> Photo:
    """Fronts from a left to a right column, of a gray, before a pale sky."""
    image = np.full((H, W), 205.0)
    for left, right, gray in fronts:
        image[ROOF:FOOT, left:right] = gray
    image += np.random.default_rng(3).normal(0, 2, image.shape)
    image = cv2.GaussianBlur(image, (0, 0), 0.7)
    return Photo("0" * 16, np.clip(image, 0, 255).astype(np.uint8), FRAME)


def _ragged(
    left: int, right: int, *, score: float = 0.9, category: Category = "facade"
) -> Instance:
    """A mask from column to column whose outline wanders by 2 px, corners round."""
    mask = np.zeros((H, W), np.float32)
    mask[ROOF:FOOT, left:right] = 1
    noise = np.random.default_rng(left).normal(0, 1, mask.shape).astype(np.float32)
    noise = cv2.GaussianBlur(noise, (0, 0), 4)
    soft = cv2.GaussianBlur(mask, (0, 0), 5) + noise * (0.06 / noise.std())
    soft[mask == 0] = np.minimum(soft[mask == 0], 0.7)
    soft[cv2.GaussianBlur(mask, (0, 0), 5) < 0.02] = 0
    return Instance(category, score, FRAME, np.clip(soft, 0, 1))


def _mask(one: Instance) -> np.ndarray:
    mask = np.zeros((H, W), bool)
    x0, y0, x1, y1 = one.box
    mask[y0:y1, x0:x1] = one.probability > 0.5
    return mask


def _sides(mask: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First and last columns of the rows between the corners."""
    rows = mask[ROOF + 15 : FOOT - 35]
    return np.argmax(rows, axis=1), W - 1 - np.argmax(rows[:, ::-1], axis=1)


@pytest.mark.parametrize("off", [-6, 0, 6])
def test_sides_move_to_the_edges_that_the_photo_shows(off: int) -> None:
    (front,) = straight(_painted((90, 220, 120)), [_ragged(90 + off, 220 + off)])
    left, right = _sides(_mask(front))
    assert np.abs(left - 90).max() <= 1
    assert np.abs(right - 219).max() <= 1


def test_a_leaning_edge_is_followed() -> None:
    painted = _painted((90, 220, 120))
    lean = np.array([[1, 0.03, -0.03 * (ROOF + FOOT) / 2], [0, 1, 0]])
    turned = cv2.warpAffine(painted.image, lean, (W, H), borderValue=205)
    (front,) = straight(Photo("0" * 16, turned, FRAME), [_ragged(93, 223)])
    rows = np.arange(ROOF + 15, FOOT - 35)
    left, _ = _sides(_mask(front))
    assert np.abs(left - 90 - 0.03 * (rows - (ROOF + FOOT) / 2)).max() <= 2


def test_the_roof_moves_to_its_edge_and_the_foot_stays() -> None:
    ragged = _ragged(90, 220)
    off = np.roll(ragged.probability, 5, axis=0)
    before = Instance("facade", 0.9, FRAME, off)
    (front,) = straight(_painted((90, 220, 120)), [before])
    columns = np.s_[:, 110:200]
    top = np.argmax(_mask(front)[columns], axis=0)
    assert np.abs(top - ROOF).max() <= 1
    assert (_mask(front)[190:, 110:200] == (off > 0.5)[190:, 110:200]).all()


def test_without_an_edge_a_side_becomes_straight_where_it_stands() -> None:
    ragged = _ragged(90, 220)
    (front,) = straight(_painted(), [ragged])
    before, after = _sides(_mask(ragged))[0], _sides(_mask(front))[0]
    assert np.std(after) < 0.5 * np.std(before)
    assert abs(after.mean() - before.mean()) <= 1


def test_what_is_round_stays_round() -> None:
    ys, xs = np.mgrid[:H, :W]
    away = np.hypot(xs - 160, ys - 120)
    dome = np.clip(0.5 + (60 - away) / 16, 0, 1).astype(np.float32)
    one = Instance("facade", 0.9, FRAME, dome)
    (front,) = straight(_painted((90, 220, 120)), [one])
    before, after = _mask(one), _mask(front)
    assert (before ^ after).sum() < 0.02 * before.sum()


@pytest.mark.parametrize("scores", [(0.9, 0.6), (0.6, 0.9)])
def test_no_gap_opens_between_neighbours(scores: tuple[float, float]) -> None:
    photo = _painted((60, 150, 120), (150, 260, 165))
    pair = [_ragged(60, 156, score=scores[0]), _ragged(156, 260, score=scores[1])]
    left, right = (_mask(one) for one in straight(photo, pair))
    middle = np.s_[ROOF + 15 : FOOT - 35, 80:240]
    assert (left | right)[middle].all()
    if scores[0] > scores[1]:
        assert np.abs(_sides(left)[1] - 149).max() <= 1


def test_a_side_that_the_frame_cuts_stays_at_the_frame() -> None:
    photo = _painted((0, 200, 120))
    (front,) = straight(photo, [_ragged(0, 200)])
    assert _mask(front)[ROOF + 15 : FOOT - 35, 0].all()


@pytest.mark.parametrize("category", ["person", "vehicle", "placard", "other"])
def test_only_fronts_are_straightened(category: Category) -> None:
    thing, front = _ragged(40, 90, category=category), _ragged(96, 226)
    photo = _painted((90, 220, 120))
    result = straight(photo, [thing, front])
    assert result[0] is thing
    assert straight(photo, [thing]) == (thing,)


def test_what_goes_in_is_not_written_on_and_the_same_comes_out() -> None:
    photo, front = _painted((90, 220, 120)), _ragged(96, 226)
    before = front.probability.copy()
    one, two = (straight(photo, [front])[0] for _ in range(2))
    assert (front.probability == before).all()
    assert (one.probability == two.probability).all()
    assert one.probability.dtype == np.float32
    assert 0 <= one.probability.min() <= one.probability.max() <= 1


def test_a_line_survives_a_fifth_of_strays() -> None:
    rows = np.arange(100)
    places = 20 + 0.1 * rows + np.random.default_rng(1).normal(0, 0.5, 100)
    places[60:80] += 30
    line = fitted(rows, places, least=50.0)
    assert line is not None
    assert abs(line.slope - 0.1) < 0.01
    assert abs(line.at - 20) < 0.5


def test_places_without_a_line_have_none() -> None:
    places = np.random.default_rng(2).uniform(0, 60, 100)
    assert fitted(np.arange(100), places, least=50.0) is None
