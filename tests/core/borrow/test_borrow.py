"""A painted front, photographed twice past other cars: what is lent, what is not."""

import cv2
import numpy as np
import pytest

from nostalgin_core import borrow, evidence, rests
from nostalgin_core.borrow import Borrowed, Lender
from nostalgin_core.records import Elevation
from tests.core.views.test_views import front

H, W = 420, 300
CAR = np.s_[330:420, 60:190]  # before the front's own photograph
OTHER_CAR = np.s_[350:420, 215:290]
VIEW = np.array([[0.92, 0.03, 6], [-0.015, 0.97, 9], [2e-5, -3e-5, 1.0]])


def wall(seed: int) -> np.ndarray:
    """A front whose ground floor is no copy of the floors above."""
    image = front(seed)
    rng = np.random.default_rng(seed + 100)
    for x in range(10, W - 40, 45):
        top = 330 + int(rng.integers(20))
        cv2.rectangle(image, (x, top), (x + 30, 410), int(rng.integers(40, 90)), -1)
        cv2.putText(image, chr(65 + x % 26), (x + 5, 345), 0, 0.8, 230, 2)
    return image


def elevation(image: np.ndarray, hidden: np.ndarray) -> Elevation:
    """An elevation as `rectify` gives it, of a facade that fills its photograph."""
    soft = (cv2.dilate(hidden.astype(np.uint8), np.ones((5, 5))) > 0) & ~hidden
    marks = np.full(image.shape, evidence.PHOTOGRAPHED, np.uint8)
    marks[soft], marks[hidden] = evidence.SOFT_EDGE, evidence.INPAINTED
    alpha = np.where(hidden, 0.0, np.where(soft, 0.4, 1.0)).astype(np.float32)
    mixed = np.where(soft, image // 2 + 10, image)
    h, w = image.shape
    return Elevation(
        facade=0,
        image=np.where(hidden, 0, mixed).astype(np.uint8),
        alpha=alpha,
        evidence=marks,
        quad=np.array([[0.0, 0], [w, 0], [w, h], [0, h]]),
        photo_from_elevation=np.eye(3),
        vanishing_points=np.eye(3)[:2],
        focal_px=None,
        aspect=w / h,
        vanishing_sd_deg=(1.0, 1.0),
        focal_sd_px=None,
        aspect_sd=0.1,
        method="painted",
    )


def behind(car: tuple[slice, slice]) -> np.ndarray:
    hidden = np.zeros((H, W), bool)
    hidden[car] = True
    return hidden


def lender(name: str, image: np.ndarray, car: tuple[slice, slice]) -> Lender:
    """The same wall from elsewhere: darker and harder print, grain, another car."""
    rng = np.random.default_rng(7)
    warp = {"dsize": (W + 20, H + 20), "borderMode": cv2.BORDER_REPLICATE}
    print_ = 0.8 * cv2.warpPerspective(image, VIEW, **warp).astype(float) + 20
    print_ = np.clip(print_ + rng.normal(0, 3, print_.shape), 0, 255).astype(np.uint8)
    hidden = cv2.warpPerspective(behind(car).astype(np.uint8), VIEW, (W + 20, H + 20))
    return Lender(name, elevation(print_, hidden > 0))


@pytest.fixture(scope="module")
def truth() -> np.ndarray:
    return wall(1)


@pytest.fixture(scope="module")
def own(truth: np.ndarray) -> Elevation:
    return elevation(truth, behind(CAR))


@pytest.fixture(scope="module")
def made(own: Elevation, truth: np.ndarray) -> Borrowed:
    return borrow.borrow(
        own, [lender("b", truth, OTHER_CAR), lender("a", wall(2), OTHER_CAR)]
    )


def test_what_a_car_hides_is_filled_from_the_neighbour_s_view(
    made: Borrowed, truth: np.ndarray
) -> None:
    hidden = behind(CAR)
    lent = hidden & (made.elevation.evidence == rests.ANOTHER)
    assert lent.sum() > 0.95 * hidden.sum()
    off = np.abs(made.elevation.image.astype(float) - truth)[lent]
    assert off.mean() < 6  # gray levels; the print's grain alone is 3
    flat = np.abs(np.median(truth) - truth.astype(float))[lent]
    assert off.mean() < 0.2 * flat.mean()


def test_what_the_own_photograph_shows_stays_bit_for_bit(
    made: Borrowed, own: Elevation
) -> None:
    seen = own.evidence == evidence.PHOTOGRAPHED
    assert np.array_equal(made.elevation.image[seen], own.image[seen])
    assert np.array_equal(made.elevation.evidence[seen], own.evidence[seen])
    assert not made.sources[seen].any()


def test_every_lent_texel_tells_its_photograph(made: Borrowed) -> None:
    assert made.photos == ("b",)
    lent = made.elevation.evidence == rests.ANOTHER
    assert np.array_equal(made.sources > 0, lent)
    assert set(np.unique(made.sources)) == {0, 1}
    assert made.fits[0].lent == lent.sum()


def test_views_that_fit_lie_within_half_a_texel(made: Borrowed) -> None:
    assert made.fits[0].fits
    assert made.fits[0].error_px < 0.5


def test_another_front_is_told_and_left_apart(made: Borrowed, own: Elevation) -> None:
    (apart,) = (one for one in made.fits if one.photo == "a")
    assert not apart.fits
    assert apart.why
    assert apart.lent == 0
    alone = borrow.borrow(own, [lender("a", wall(2), OTHER_CAR)])
    assert np.array_equal(alone.elevation.image, own.image)
    assert np.array_equal(alone.elevation.evidence, own.evidence)
    assert alone.photos == ()


def test_a_shop_that_was_rebuilt_in_between_lends_nothing(
    own: Elevation, truth: np.ndarray
) -> None:
    rebuilt = truth.copy()
    rng = np.random.default_rng(5)
    low = rebuilt[300:]
    low[:] = cv2.resize(rng.integers(0, 255, (8, 20)).astype(np.uint8), low.shape[::-1])
    made = borrow.borrow(own, [lender("b", rebuilt, OTHER_CAR)])
    assert np.mean(made.elevation.evidence[CAR] == rests.ANOTHER) < 0.1


def test_a_mirror_printed_negative_lends_nothing_and_is_named(
    own: Elevation, truth: np.ndarray
) -> None:
    made = borrow.borrow(own, [lender("b", truth[:, ::-1].copy(), OTHER_CAR)])
    (fit,) = made.fits
    assert not fit.fits
    assert "mirror" in fit.why
    assert made.photos == ()
    assert np.array_equal(made.elevation.image, own.image)
    other = borrow.borrow(own, [lender("b", wall(2), OTHER_CAR)])
    assert "mirror" not in other.fits[0].why


def test_a_lot_taken_again_after_it_was_rebuilt_is_told_beside_one_that_was_not(
    own: Elevation, truth: np.ndarray
) -> None:
    views = [lender("later", wall(3), OTHER_CAR), lender("then", truth, OTHER_CAR)]
    made = borrow.borrow(own, views)
    assert {one.photo: one.fits for one in made.fits} == {"later": False, "then": True}
    assert made.photos == ("then",)


def test_what_a_lender_s_car_hides_is_not_taken_from_it(truth: np.ndarray) -> None:
    own = elevation(truth, behind(CAR) | behind(OTHER_CAR))
    made = borrow.borrow(own, [lender("b", truth, OTHER_CAR)])
    assert not (made.elevation.evidence[OTHER_CAR] == rests.ANOTHER).any()
    both = borrow.borrow(own, [lender("b", truth, OTHER_CAR), lender("c", truth, CAR)])
    assert np.mean(both.sources[OTHER_CAR] == 2) > 0.9
    assert np.mean(both.sources[CAR] == 1) > 0.9


def test_a_front_without_holes_and_one_without_lenders_stay_as_they_are(
    own: Elevation, truth: np.ndarray
) -> None:
    whole = elevation(truth, np.zeros((H, W), bool))
    assert borrow.borrow(whole, [lender("b", truth, CAR)]).elevation is whole
    assert borrow.borrow(own, []).elevation is own


def test_the_same_views_lend_the_same_bytes(made: Borrowed, own: Elevation) -> None:
    views = [lender("b", wall(1), OTHER_CAR), lender("a", wall(2), OTHER_CAR)]
    again = borrow.borrow(own, views)
    assert np.array_equal(again.elevation.image, made.elevation.image)
    assert np.array_equal(again.sources, made.sources)
    turned = borrow.borrow(own, views[::-1])
    assert np.array_equal(turned.elevation.image, made.elevation.image)
    assert turned.photos == made.photos
