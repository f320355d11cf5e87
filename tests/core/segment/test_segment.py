import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

import nostalgin_core
from nostalgin_core import session
from nostalgin_core.matte import facade
from nostalgin_core.measure.segmentation import overlap
from nostalgin_core.photo import photo
from nostalgin_core.records import Box, Photo, Rejection
from nostalgin_core.segment.segment import (
    CATEGORIES,
    Network,
    laid_over,
    prepared,
    segment,
)
from tests.data import DATA, needs_data
from tests.outdoors import outdoors

FACADE = CATEGORIES.index("facade") + 1
PERSON = CATEGORIES.index("person") + 1


def _photo(h: int = 400, w: int = 300, frame: Box | None = None) -> Photo:
    image = np.random.default_rng(0).integers(0, 255, (h, w)).astype(np.uint8)
    return Photo("a photo", image, frame or Box(0, 0, w, h))


def _answering(
    *things: tuple[tuple[float, float, float, float], int, float],
) -> Network:
    """A network that finds the same things, in shares of its input, in any photo."""

    def network(gray: np.ndarray) -> tuple[np.ndarray, ...]:
        height, width = gray.shape[-2:]
        shares = np.array([t[0] for t in things], np.float32).reshape(-1, 4)
        boxes = shares * np.array([width, height] * 2, np.float32)
        labels = np.array([t[1] for t in things], np.int64)
        scores = np.array([t[2] for t in things], np.float32)
        masks = np.ones((len(things), 28, 28), np.float32)
        # Pixels that know little: they doubt what masks say, and outvote none.
        pixels = np.full((4, height // 4, width // 4), 0.5, np.float32)
        pixels[0], pixels[2] = 0.1, 0.4
        return boxes, labels, scores, masks, pixels, outdoors(gray)

    return network


def test_boxes_return_to_the_photo_whatever_size_the_network_saw() -> None:
    network = _answering(((0.25, 0.5, 0.75, 1.0), FACADE, 0.9))
    for short_px in (128, 320, 640):
        (found,) = segment(_photo(), network, short_px=short_px)
        assert found.box == Box(75, 200, 225, 400)
        assert found.probability.shape == (200, 150)
        assert found.probability.min() > 0.7


def test_a_network_that_says_nothing_of_pixels_is_refused() -> None:
    older = _answering(((0.25, 0.5, 0.75, 1.0), FACADE, 0.9))
    with pytest.raises(ValueError, match="older than this program"):
        segment(_photo(), lambda gray: older(gray)[:4])


def test_only_the_exposed_frame_is_shown_to_the_network() -> None:
    network = _answering(((0.0, 0.0, 1.0, 1.0), FACADE, 0.9))
    (found,) = segment(_photo(frame=Box(20, 30, 280, 390)), network)
    assert found.box == Box(20, 30, 280, 390)


def test_things_come_surest_first_and_unsure_ones_are_dropped() -> None:
    half = (0.0, 0.0, 0.5, 0.5)
    network = _answering(
        (half, FACADE, 0.5), (half, PERSON, 0.7), (half, FACADE, 0.2), (half, 3, 0.1)
    )
    found = segment(_photo(), network, facade_score=0.4, occluder_score=0.4)
    assert [(f.category, round(f.score, 3)) for f in found] == [
        ("person", 0.7),
        ("facade", 0.5),
    ]


def test_of_several_placards_only_the_surest_is_kept() -> None:
    half = (0.0, 0.0, 0.5, 0.5)
    board = CATEGORIES.index("placard") + 1
    network = _answering(
        (half, FACADE, 0.5), (half, board, 0.6), (half, board, 0.9), (half, PERSON, 0.3)
    )
    found = segment(_photo(), network)
    assert [(f.category, round(f.score, 3)) for f in found] == [
        ("placard", 0.9),
        ("facade", 0.5),
        ("person", 0.3),
    ]


def test_a_photo_without_front_is_rejected_with_its_remedy() -> None:
    for things in ([], [((0.0, 0.0, 0.5, 0.5), PERSON, 0.9)]):
        answer = segment(_photo(), _answering(*things))
        assert isinstance(answer, Rejection)
        assert (answer.stage, answer.reason) == ("segment", "no facade found")
        assert "lower facade_score" in answer.detail


@pytest.mark.parametrize("size", [(840, 560), (388, 584), (100, 900), (64, 64)])
def test_the_network_sees_multiples_of_its_stride_at_its_scale(
    size: tuple[int, int],
) -> None:
    gray = prepared(np.zeros(size, np.uint8), short_px=640, long_px=1344)
    assert all(side % 32 == 0 and side >= 32 for side in gray.shape)
    assert min(gray.shape) <= 640
    assert max(gray.shape) <= 1344
    assert min(gray.shape) == 640 or max(gray.shape) == 1344


@pytest.mark.parametrize("texels", [28, 33, 46])
def test_a_mask_is_stretched_as_opencv_stretches_it(texels: int) -> None:
    mask = np.random.default_rng(3).random((texels, texels)).astype(np.float32)
    box, probability = laid_over(mask, np.array([10.0, 20.0, 150.0, 110.0]), (200, 200))
    assert box == Box(10, 20, 150, 110)
    want = cv2.resize(mask, (140, 90), interpolation=cv2.INTER_LINEAR)
    np.testing.assert_allclose(probability, want, atol=2e-5)


def test_a_mask_that_leaves_the_photo_is_cut_there() -> None:
    mask = np.random.default_rng(3).random((28, 28)).astype(np.float32)
    _, whole = laid_over(mask, np.array([100.0, 100.0, 160.0, 180.0]), (300, 300))
    box, cut = laid_over(mask, np.array([0.0, 0.0, 60.0, 80.0]) - 20, (300, 300))
    assert box == Box(0, 0, 40, 60)
    np.testing.assert_allclose(cut, whole[20:, 20:], atol=1e-6)


def test_a_box_without_pixels_places_nothing() -> None:
    mask = np.ones((28, 28), np.float32)
    assert laid_over(mask, np.array([310.0, 0.0, 330.0, 20.0]), (300, 300)) is None


@pytest.fixture(scope="module")
def shipped() -> Network:
    models = Path(nostalgin_core.__file__).parent / "models"
    sums = json.loads((models / "models.lock").read_text())
    return session.load((models / "segment.onnx").read_bytes(), sums["segment.onnx"])


def _taxphoto(name: str) -> Photo:
    path = next((DATA / "taxphotos" / "photos").glob(f"*{name}.jpg"))
    decoded = photo.decode(path.read_bytes(), name=name)
    assert isinstance(decoded, Photo)
    return decoded


@needs_data
@pytest.mark.parametrize("level", [1, 254])
def test_a_hole_punched_through_a_front_is_no_front(
    shipped: Network, level: int
) -> None:
    whole = _taxphoto("00993_0043")
    centre, radius = (280, 480), 50  # on the target front, as wide as real punches
    disc = cv2.circle(np.zeros(whole.image.shape, np.uint8), centre, radius, 1, -1) > 0
    punched = replace(whole, image=np.where(disc, level, whole.image).astype(np.uint8))
    before, after = (segment(one, shipped) for one in (whole, punched))
    assert isinstance(before, tuple)
    assert isinstance(after, tuple)
    assert facade.covered_by(before, disc.shape)[disc].mean() < 0.1
    assert facade.covered_by(after, disc.shape)[disc].mean() > 0.8


@needs_data
def test_a_watermark_does_not_hide_the_target(shipped: Network) -> None:
    plain = _taxphoto("00993_0043")
    letters = np.zeros(plain.image.shape, np.uint8)
    for y in range(80, letters.shape[0], 170):
        place, font = (10, y), cv2.FONT_HERSHEY_SIMPLEX
        cv2.putText(letters, "MUNICIPAL ARCHIVES", place, font, 1.6, 1, 3)
    marked = np.clip(plain.image + 20.0 * letters, 0, 255).astype(np.uint8)
    targets = []
    for one in (plain, replace(plain, image=marked)):
        found = segment(one, shipped)
        assert isinstance(found, tuple)
        arranged = facade.arrange(one, found)
        assert isinstance(arranged, tuple)
        targets.append(np.any([f.mask for f in arranged if f.target], axis=0))
    assert overlap(*targets) > 0.5  # it does move them: docs/segmentation.md


@needs_data
def test_the_shipped_network_finds_the_building_a_board_stands_before(
    shipped: Network,
) -> None:
    path = next((DATA / "taxphotos" / "photos").glob("*00993_0104.jpg"))
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    found = segment(Photo("993-104", image, Box(0, 0, 560, 840)), shipped)
    categories = {f.category for f in found}
    assert {"facade", "vehicle", "placard"} <= categories
    # By the labels the target front's middle is at (297, 454).
    middle = [
        f
        for f in found
        if f.category == "facade"
        and f.box.x0 < 297 < f.box.x1
        and f.box.y0 < 454 < f.box.y1
    ]
    assert middle
