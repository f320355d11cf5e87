import cv2
import numpy as np
import pytest

from nostalgin_core.records import Box, Instance, Photo
from nostalgin_core.segment.sky import without_sky

H, W = 840, 560
WEDGE = np.array([[360, 60], [470, 60], [470, 420]])  # of sky, right of a gable
FRONT = Box(120, 60, 470, 700)


def painted(sky: float = 225.0, wall: float = 130.0, *, plaster: float = 0.0) -> Photo:
    """Paint a gable before the sky; within it, a share of its height may be plaster."""
    rng = np.random.default_rng(0)
    street = np.full((H, W), sky)
    house = np.zeros((H, W), np.uint8)
    cv2.rectangle(house, (FRONT.x0, FRONT.y0), (FRONT.x1 - 1, FRONT.y1 - 1), 1, -1)
    cv2.fillPoly(house, [WEDGE], 0)
    street[house > 0] = wall
    street[120:680:60, :] -= 60.0 * house[120:680:60, :]
    if plaster:
        street[500 - round(640 * plaster) : 500, 160:340] = sky
    street[700:] = 90.0
    street += rng.normal(0.0, 2.0, street.shape)
    return Photo("p", np.clip(street, 0, 255).astype(np.uint8), Box(0, 0, W, H))


def thing(box: Box, category: str = "facade") -> Instance:
    whole = np.ones((box.y1 - box.y0, box.x1 - box.x0), np.float32)
    return Instance(category, 0.9, box, whole)


def wedge(front: Instance) -> tuple[float, float]:
    """Tell which shares of the wedge, and of the wall, a front still claims."""
    inside = np.zeros((H, W), np.uint8)
    cv2.fillPoly(inside, [WEDGE], 1)
    there = inside[FRONT.y0 : FRONT.y1, FRONT.x0 : FRONT.x1] > 0
    own = front.probability > 0.5
    return float(own[there].mean()), float(own[~there].mean())


def test_sky_in_a_mask_is_taken_off_the_front_and_no_wall_is() -> None:
    (front,) = without_sky(painted(), [thing(FRONT)])
    in_wedge, on_wall = wedge(front)
    assert in_wedge < 0.03
    assert on_wall > 0.98


@pytest.mark.parametrize(
    "photo",
    [
        painted(plaster=0.1),  # something else on the front is as bright
        painted(wall=225.0),  # all of it is
        painted(sky=150.0),  # what lies round it is too dark to be sky for sure
    ],
    ids=["plaster", "white", "dusk"],
)
def test_a_front_that_tones_don_t_tell_from_sky_stays_whole(photo: Photo) -> None:
    front = thing(FRONT)
    assert without_sky(photo, [front]) == (front,)


def test_without_any_sky_nothing_is_taken() -> None:
    everything = thing(Box(0, 0, W, H))
    assert without_sky(painted(), [everything]) == (everything,)


def test_what_hides_a_front_keeps_its_mask() -> None:
    lamp = thing(Box(380, 60, 400, 300), "other")
    assert without_sky(painted(), [thing(FRONT), lamp])[1] is lamp


def test_a_finer_scan_gives_up_the_same() -> None:
    photo = painted()
    fine = cv2.resize(photo.image, (2 * W, 2 * H), interpolation=cv2.INTER_CUBIC)
    double = Box(*(2 * side for side in FRONT))
    (coarse,) = without_sky(photo, [thing(FRONT)])
    (same,) = without_sky(Photo("p", fine, Box(0, 0, 2 * W, 2 * H)), [thing(double)])
    halved = same.probability[::2, ::2] > 0.5
    assert np.mean(halved != (coarse.probability > 0.5)) < 0.005
