import json
from pathlib import Path

import cv2
import numpy as np
import pytest

import nostalgin_core
from nostalgin_core import session
from nostalgin_core.photo import framed
from nostalgin_core.records import Box, Instance, Photo, Rejection
from nostalgin_core.segment import Network, segment
from nostalgin_core.segment.indoors import (
    BOARD,
    ENOUGH,
    REASON,
    inside,
    log_odds,
    shares,
)
from nostalgin_core.segment.segment import everything
from tests.data import DATA, needs_data

SHEET = Box(10, 20, 650, 436)  # 20 x 13 cells of 32 px
FRAME = Box(26, 52, 554, 404)


def test_a_photograph_is_as_likely_in_a_room_as_its_cells_say_in_the_mean() -> None:
    say = np.random.default_rng(0).normal(size=(1, 13, 20)).astype(np.float32)
    assert log_odds(say, SHEET, SHEET) == pytest.approx(float(say.mean()), abs=1e-6)


def test_what_lies_on_the_paper_has_no_say() -> None:
    say = np.full((1, 13, 20), 2, np.float32)
    told = log_odds(say, SHEET, FRAME)
    assert told == pytest.approx(2)
    say[:, :1], say[:, 12:], say[..., 17:] = 1e6, 1e6, 1e6
    assert log_odds(say, SHEET, FRAME) == pytest.approx(told)


def test_a_cell_that_the_frame_cuts_has_its_share() -> None:
    down, across = shares((13, 20), SHEET, FRAME)
    assert down.sum() == pytest.approx(1)
    assert across.sum() == pytest.approx(1)
    assert across[0] == pytest.approx(across[1] / 2)
    assert down[1:12] == pytest.approx(np.full(11, 1 / 11))


def _saying(logit: float) -> Network:
    """A network that finds a front in every picture, and says where it was taken."""

    def network(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        height, width = gray.shape[-2:]
        box = np.array([[0.2 * width, 0.2 * height, 0.8 * width, 0.8 * height]])
        pixels = np.full((4, height // 4, width // 4), 0.5, np.float32)
        pixels[1] = 0.97
        one = np.ones(1, np.float32)
        say = np.full((1, height // 32, width // 32), logit, np.float32)
        masks = np.ones((1, 28, 28), np.float32)
        return box.astype(np.float32), np.ones(1, int), one, masks, pixels, say

    return network


def test_a_room_is_refused_by_name_and_a_street_is_not() -> None:
    rng = np.random.default_rng(3)
    photo = framed("a photo", rng.integers(60, 200, (416, 416), np.uint8))
    refused = segment(photo, _saying(ENOUGH + 0.1))
    assert isinstance(refused, Rejection)
    assert refused.reason == REASON
    assert "draw the outline" in refused.detail
    other = segment(photo, _saying(ENOUGH - 0.1))
    assert getattr(other, "reason", "") != REASON


def test_a_number_board_stands_on_a_street() -> None:
    def board(score: float) -> Instance:
        return Instance("placard", score, Box(0, 0, 9, 9), np.ones((9, 9), np.float32))

    assert inside(ENOUGH + 1, ())
    assert inside(ENOUGH + 1, (board(BOARD - 0.1),))
    assert not inside(ENOUGH + 1, (board(BOARD - 0.1), board(BOARD)))
    assert not inside(ENOUGH - 1, ())


@pytest.fixture(scope="module")
def shipped() -> Network:
    folder = Path(nostalgin_core.__file__).parent / "models"
    sums = json.loads((folder / "models.lock").read_text())
    return session.load((folder / "segment.onnx").read_bytes(), sums["segment.onnx"])


def _real(folder: str, name: str) -> Photo:
    path = next((DATA / folder).rglob(f"*{name}.jpg"))
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    assert image is not None
    return framed(name, image)


@needs_data
@pytest.mark.parametrize(
    "name",
    [
        *("703840f-a", "703840f-b", "717371f-a"),
        pytest.param(
            "716168f-a",
            marks=pytest.mark.xfail(
                reason="docs/segmentation.md says why", strict=True
            ),
        ),
    ],
)
def test_real_rooms_that_taught_nothing_are_refused_by_name(
    name: str, shipped: Network
) -> None:
    refused = segment(_real("historic_streets", name), shipped)
    assert isinstance(refused, Rejection)
    assert refused.reason == REASON


@needs_data
@pytest.mark.parametrize(
    ("folder", "name"),
    [
        *(("taxphotos", one) for one in ("00996_0046", "00993_0010", "00993_0038")),
        *(("historic_streets", one) for one in ("721804f-b", "708006f-c", "717493f-c")),
        ("york_urban", "P1030001"),
    ],
)
def test_real_streets_that_look_most_like_rooms_are_none(
    folder: str, name: str, shipped: Network
) -> None:
    photo = _real(folder, name)
    found = everything(photo, shipped, least=0.2)
    assert not inside(found.indoors, found.things)
