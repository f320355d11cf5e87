"""A front ends above the wheels before it, where its street's other fronts end."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from nostalgin_core import homography, rectify
from nostalgin_core.arrays import Alpha, Mask
from nostalgin_core.records import (
    Box,
    Category,
    Elevation,
    Facade,
    Matted,
    Occluder,
    Rejection,
)
from nostalgin_core.rectify import camera, foot
from tests.painted_front import photograph

SHAPE = (800, 600)
FRAME = Box(0, 0, 600, 800)
PLANE = np.array([[500.0, 0, 300], [0, 500, 400], [0, 0, 1]])  # horizon at row 400


def meant(index: int, seen: Mask, whole: Mask, alpha: Alpha) -> Facade:
    return Facade(
        index, 0.9, target=True, target_score=0.9, mask=seen, amodal=whole, alpha=alpha
    )


def front(x0: int, x1: int, top: int, seen: int, end: int) -> tuple[Facade, foot.Stand]:
    """A front seen straight on down to row `seen`, and thought to end at `end`."""
    alpha = np.zeros(SHAPE, np.float32)
    alpha[top:seen, x0:x1] = 1
    whole = np.zeros(SHAPE, bool)
    whole[top:end, x0:x1] = True
    corners = np.array([[x0, top], [x1, end]], float)
    (left, up), (right, down) = homography.apply(np.linalg.inv(PLANE), corners)
    bounds = np.array([left, up, right, down])
    facade = meant(0, alpha > 0, whole, alpha)
    return facade, foot.Stand(PLANE, bounds, 0.0, 0.1)


def before(category: Category, x0: int, x1: int, top: int, end: int) -> Occluder:
    mask = np.zeros(SHAPE, bool)
    mask[top:end, x0:x1] = True
    return Occluder(category, 0.9, mask)


def rows(fronts: list, hiders: list[Occluder]) -> list[float]:
    """Tell where fronts end, in rows of the photo."""
    facades, stands = zip(*fronts, strict=True)
    found = foot.feet(facades, stands, foot.touches(hiders, FRAME))
    return [400 + 500 * y for y in found if y is not None]


def test_a_front_ends_above_the_wheels_of_the_car_before_it() -> None:
    car = before("vehicle", 210, 330, 450, 550)
    (end,) = rows([front(200, 400, 100, 485, 520)], [car])
    assert end == pytest.approx(400 + 150 / foot.BEFORE["vehicle"], abs=1)


def test_what_a_camera_saw_of_a_front_is_not_given_up() -> None:
    car = before("vehicle", 210, 240, 420, 440)
    (end,) = rows([front(200, 400, 100, 500, 520)], [car])
    assert end == pytest.approx(500, abs=6)


@pytest.mark.parametrize(
    "hiders",
    [
        [before("other", 210, 330, 380, 460)],  # a sign hangs where it likes
        [before("vehicle", 210, 330, 450, 800)],  # its wheels are beyond the frame
        [before("person", 210, 250, 420, 460), before("vehicle", 200, 390, 455, 790)],
    ],
)
def test_what_does_not_show_where_it_stands_tells_nothing(
    hiders: list[Occluder],
) -> None:
    (end,) = rows([front(200, 400, 100, 480, 500)], hiders)
    assert end == pytest.approx(500, abs=1)


def test_most_fronts_of_a_street_tell_where_one_of_them_ends() -> None:
    others = [front(0, 190, 100, 440, 450), front(410, 600, 120, 440, 452)]
    deep = front(200, 400, 100, 430, 560)
    assert rows([others[0], deep, others[1]], [])[1] == pytest.approx(452, abs=1)
    round_the_corner = [(one, stand._replace(azimuth=1.4)) for one, stand in others]
    found = rows([round_the_corner[0], deep, round_the_corner[1]], [])
    assert found[1] > 470


def test_of_what_nobody_tells_the_more_is_thought_hidden_the_less_is_true() -> None:
    seen, ends = 455, [460, 500, 560, 640, 780]
    found = [rows([front(200, 400, 100, seen, end)], [])[0] for end in ends]
    assert found == sorted(found)
    assert found[0] == pytest.approx(ends[0], abs=1)
    shares = [(a - seen) / (b - seen) for a, b in zip(found, ends, strict=True)]
    assert shares == sorted(shares, reverse=True)
    assert shares[-1] < 0.5


def test_a_front_that_is_not_seen_or_not_bounded_keeps_what_it_had() -> None:
    facade, stand = front(200, 400, 100, 455, 520)
    dark = replace(facade, alpha=np.zeros(SHAPE, np.float32))
    assert foot.feet([dark, facade], [stand, None], [])[1] is None
    assert rows([(dark, stand)], []) == [pytest.approx(520)]


def test_a_painted_front_ends_nearer_to_the_ground_for_the_car_before_it() -> None:
    painted = photograph(tilt_deg=2.0, aspects=(0.8,), azimuths_deg=(20.0,))
    matrix = camera.matrix(painted.focal_px, painted.photo.frame)
    plane, whole = matrix @ painted.planes[0], painted.matted.facades[0]
    _, down, top = painted.planes[0].T
    horizon = -(top @ down) / (down @ down)
    wheels = horizon + 1.6 * (1 - horizon)  # as far below it as a car's are
    car = np.zeros(SHAPE, bool)
    outline = np.array([[0.1, 0.9], [0.9, 0.9], [0.9, wheels], [0.1, wheels]])
    corners = np.rint(homography.apply(plane, outline)).astype(np.int32)
    cv2.fillPoly(view := car.astype(np.uint8), [corners], 1)
    car = view > 0
    seen = np.where(car, 0, whole.alpha).astype(np.float32)
    facade = meant(0, seen > 0.5, whole.amodal | car, seen)
    hider = Occluder("vehicle", 0.9, car)
    (known,) = rectify.rectify(painted.photo, Matted((facade,), (hider,)))
    assert wheels > 1.1  # so far down its outline reaches
    assert abs(below(painted.quads[0], known)) < (wheels - 1) / 4


def below(true: np.ndarray, view: Elevation | Rejection) -> float:
    """Tell by how much of its height a quad reaches below a painted front's foot."""
    assert isinstance(view, Elevation)
    texels = homography.apply(np.linalg.inv(view.photo_from_elevation), true)
    height = texels[2:, 1].mean() - texels[:2, 1].mean()
    return float((view.image.shape[0] - texels[2:, 1].mean()) / height)
