import json
from pathlib import Path

import cv2
import numpy as np
import pytest

import nostalgin_core
from nostalgin_core import session
from nostalgin_core.photo import framed
from nostalgin_core.records import Rejection
from nostalgin_core.segment import Network, segment
from nostalgin_core.segment.posture import (
    POSTURES,
    Doubt,
    Posture,
    cues,
    doubted,
    excess,
    sure,
    undone,
)
from tests.data import DATA, needs_data
from tests.outdoors import outdoors

FALLEN = {  # of historic_streets
    "702455f-a": "turned by 90 degrees",
    "719051f-a": "turned by 90 degrees",
    "711673f-c": "a negative",
    "712738f-c": "a negative",
    "713264f-f": "a negative",
    "713416f-b": "a negative",
    "717525f-b": "a negative",
}
STANDING = ("00993_0008a", "00996_0034")  # of taxphotos
DOUBTED = ("719749f-a", "713615f-b", "707935f-a")  # by cues alone, though they stand


def _street(h: int = 400, w: int = 300) -> np.ndarray:
    """Light sky, fronts full of windows, a quiet road."""
    rng = np.random.default_rng(3)
    image = np.full((h, w), 225.0)
    image[h // 4 : 5 * h // 6] = 120
    for y in range(h // 4 + 8, 5 * h // 6 - 20, 28):
        for x in range(6, w - 12, 22):
            image[y : y + 18, x : x + 10] = 45
    image[5 * h // 6 :] = 90
    return np.clip(image + rng.normal(0, 4, (h, w)), 0, 255).astype(np.uint8)


def _back(posture: Posture) -> Posture:
    """What undoes an undoing."""
    return posture._replace(quarters=-posture.quarters)


@pytest.mark.parametrize("posture", POSTURES)
def test_what_is_undone_and_done_again_is_as_it_was(posture: Posture) -> None:
    street = _street()
    again = undone(undone(street, posture), _back(posture))
    assert np.array_equal(again, street)


def test_turning_a_photograph_only_changes_the_order_of_its_postures() -> None:
    street = _street(300, 300)
    told = cues(street)
    turned = cues(undone(street, POSTURES[1]))
    assert turned[:4] == pytest.approx(told[[1, 2, 3, 0]], abs=0.01)


def test_an_upright_street_is_not_doubted() -> None:
    assert doubted(_street()) == ()


@pytest.mark.parametrize("posture", POSTURES[1:])
def test_a_fallen_street_is_doubted_and_the_right_posture_tried(
    posture: Posture,
) -> None:
    told = doubted(undone(_street(), _back(posture)))
    assert posture in [one.posture for one in told]


def _knowing(share: float) -> np.ndarray:
    """What a network says that is sure of a share of all pixels."""
    pixels = np.full((4, 10, 10), 0.4, np.float32)
    pixels[1, : round(10 * share)] = 0.95
    pixels[3] = 0.99  # an end is no kind
    return pixels


def test_a_network_is_surer_where_it_knows_more_pixels() -> None:
    assert sure(_knowing(0.3)) == pytest.approx(0.3)


@pytest.mark.parametrize("posture", POSTURES[1:])
def test_cues_alone_refuse_nothing(posture: Posture) -> None:
    certain = Doubt(posture, 50.0)
    assert excess(certain, 0.5, 0.5) <= 0
    assert excess(certain, 0.4, 0.5) <= 0
    assert excess(certain, 0.6, 0.5) > 0


@pytest.mark.parametrize("posture", POSTURES[1:])
def test_the_surer_the_network_the_less_cues_have_to_say(posture: Posture) -> None:
    assert excess(Doubt(posture, 1.5), 0.6, 0.5) <= 0
    assert excess(Doubt(posture, 1.5), 0.9, 0.5) > 0


def test_a_network_that_knows_nothing_is_not_divided_by() -> None:
    assert excess(Doubt(POSTURES[1], 9.0), 0.0, 0.0) <= 0
    assert excess(Doubt(POSTURES[1], 9.0), 0.1, 0.0) > 0


def _surest_of(kind: int) -> Network:
    """A network that knows every pixel of one picture, and finds a front in any."""

    def network(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        height, width = gray.shape[-2:]
        box = np.array([[0.2 * width, 0.2 * height, 0.8 * width, 0.8 * height]])
        pixels = np.full((4, height // 4, width // 4), 0.5, np.float32)
        sky, foot = gray[0, 0, : height // 5].mean(), gray[0, 0, -height // 7 :].mean()
        if np.sign(sky - foot) == kind:
            pixels[1] = 0.97
        one = np.ones(1, np.float32)
        masks = np.ones((1, 28, 28), np.float32)
        return (
            box.astype(np.float32),
            np.ones(1, int),
            one,
            masks,
            pixels,
            outdoors(gray),
        )

    return network


@pytest.mark.parametrize("posture", POSTURES[2:5:2])
def test_a_photo_is_refused_where_the_network_agrees(posture: Posture) -> None:
    image = undone(_street(416, 416), _back(posture))
    photo = framed("a photo", image)
    refused = segment(photo, _surest_of(1))
    assert isinstance(refused, Rejection)
    assert refused.reason == posture.reason
    assert posture.remedy in refused.detail
    other = segment(photo, _surest_of(-1))
    assert getattr(other, "reason", "") != posture.reason


@pytest.fixture(scope="module")
def shipped() -> Network:
    folder = Path(nostalgin_core.__file__).parent / "models"
    sums = json.loads((folder / "models.lock").read_text())
    return session.load((folder / "segment.onnx").read_bytes(), sums["segment.onnx"])


def _real(folder: str, name: str) -> np.ndarray:
    path = next((DATA / folder / "photos").glob(f"*{name}.jpg"))
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    assert image is not None
    return image


@needs_data
@pytest.mark.parametrize("name", FALLEN)
def test_real_photographs_that_fell_are_told_which_way(
    name: str, shipped: Network
) -> None:
    image = _real("historic_streets", name)
    refused = segment(framed(name, image), shipped)
    assert isinstance(refused, Rejection)
    assert refused.reason == FALLEN[name]


@needs_data
@pytest.mark.parametrize("name", STANDING)
def test_real_photographs_that_stand_are_segmented_until_they_are_turned(
    name: str, shipped: Network
) -> None:
    image = _real("taxphotos", name)
    assert isinstance(segment(framed(name, image), shipped), tuple)
    turned = undone(image, POSTURES[2])
    refused = segment(framed(name, turned), shipped)
    assert isinstance(refused, Rejection)
    assert refused.reason == "upside down"


@needs_data
@pytest.mark.parametrize("name", DOUBTED)
def test_what_cues_alone_doubt_is_not_refused(name: str, shipped: Network) -> None:
    image = _real("historic_streets", name)
    photo = framed(name, image)
    x0, y0, x1, y1 = photo.sheet or photo.frame
    assert doubted(image[y0:y1, x0:x1])
    told = segment(photo, shipped)
    assert getattr(told, "reason", "") not in {one.reason for one in POSTURES}
