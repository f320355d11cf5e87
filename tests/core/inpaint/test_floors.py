from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core import evidence
from nostalgin_core.inpaint import floors
from nostalgin_core.inpaint.floors import repeated
from nostalgin_core.records import Elevation

ROWS, STOREYS, WIDTH = 40, 6, 160
HEIGHT = round(ROWS * (STOREYS + 0.7))
SMEAR = 110


def front(hole: tuple[slice, slice], *, repeats: bool = True) -> tuple[Elevation, ...]:
    """Paint a front, and the same with a hole that was filled with gray."""
    rng = np.random.default_rng(3)
    storey = np.full((ROWS, WIDTH), 180.0)
    for x in (15, 50, 90, 130):
        storey[10:32, x : x + 16] = 60
    rows = [storey + rng.normal(0, 3, storey.shape) for _ in range(STOREYS + 1)]
    if not repeats:
        rows = [rng.normal(140, 40, (1, WIDTH)) + np.zeros((ROWS, 1)) for _ in rows]
    image = np.clip(np.vstack(rows)[-HEIGHT:], 0, 255).astype(np.uint8)
    marks = np.full(image.shape, evidence.PHOTOGRAPHED, np.uint8)
    whole = Elevation(
        facade=0,
        image=image,
        alpha=np.ones(image.shape, np.float32),
        evidence=marks,
        quad=np.zeros((4, 2)),
        photo_from_elevation=np.eye(3),
        vanishing_points=np.zeros((2, 3)),
        focal_px=None,
        aspect=WIDTH / HEIGHT,
        vanishing_sd_deg=(1.0, 1.0),
        focal_sd_px=None,
        aspect_sd=0.01,
        method="",
    )
    marks, image = marks.copy(), image.copy()
    marks[hole], image[hole] = evidence.INPAINTED, SMEAR
    return whole, replace(whole, image=image, evidence=marks)


FOOT = np.s_[HEIGHT - 2 * ROWS :, 30:]


def test_a_hidden_foot_gets_the_windows_of_the_floors_above() -> None:
    whole, filled = front(FOOT)
    made = repeated(filled)
    deep = np.s_[HEIGHT - ROWS :, 45:]
    assert np.all(made.evidence[deep] == evidence.COPIED)

    def unlike(one: Elevation) -> float:
        apart = one.image[deep] * 1.0 - whole.image[deep]
        return float(np.std(apart - apart.mean()))

    assert unlike(made) < 0.5 * unlike(filled)


def test_photographed_texels_stay_bit_for_bit() -> None:
    _, filled = front(FOOT)
    made = repeated(filled)
    seen = filled.evidence == evidence.PHOTOGRAPHED
    assert (made.image[seen] == filled.image[seen]).all()
    assert (made.evidence[seen] == evidence.PHOTOGRAPHED).all()


def test_the_tone_stays_that_of_the_fill() -> None:
    _, filled = front(FOOT)
    deep = np.s_[HEIGHT - ROWS :, 45:]
    assert abs(repeated(filled).image[deep].mean() - SMEAR) < 12


@pytest.mark.parametrize("hole", [np.s_[100:118, 40:90], np.s_[:, 150:]])
def test_a_hole_too_small_for_a_storey_stays_as_it_was_filled(
    hole: tuple[slice, slice],
) -> None:
    _, filled = front(hole)
    made = repeated(filled)
    assert (made.image == filled.image).all()
    assert (made.evidence == filled.evidence).all()


def test_a_front_on_which_nothing_repeats_stays_as_it_was_filled() -> None:
    _, filled = front(FOOT, repeats=False)
    assert repeated(filled) is filled


def test_a_front_without_holes_stays() -> None:
    whole, _ = front(FOOT)
    assert repeated(whole) is whole


def test_what_is_copied_from_a_fill_is_called_a_fill() -> None:
    seen = np.ones((9, 4), bool)
    seen[3:6, 0] = False
    told = floors.source(seen, (3, 3))
    assert not told[:, 0].any()
    assert told[:, 1:].all()
