import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core import evidence
from nostalgin_core.inpaint.inpaint import GUESSED_PX, holes, inpaint, low_memory, whole
from nostalgin_core.inpaint.slices import CHUNK_PX, merged, slices
from nostalgin_core.records import Box, Elevation


def front(h: int, w: int, *, period: int = 24) -> np.ndarray:
    """Paint a front whose windows repeat."""
    y, x = np.mgrid[:h, :w]
    dark = (x % period > period // 3) & (y % (period + 8) > period // 2)
    return np.where(dark, 60, 180).astype(np.uint8)


def elevation(image: np.ndarray, marks: np.ndarray) -> Elevation:
    hole = holes(marks)
    return Elevation(
        facade=0,
        image=np.where(hole, 0, image).astype(np.uint8),
        alpha=(marks == evidence.PHOTOGRAPHED).astype(np.float32),
        evidence=marks,
        quad=np.zeros((4, 2)),
        photo_from_elevation=np.eye(3),
        vanishing_points=np.zeros((2, 3)),
        focal_px=None,
        aspect=1.0,
        vanishing_sd_deg=(0.0, 0.0),
        focal_sd_px=None,
        aspect_sd=0.0,
        method="painted",
    )


def marked(h: int, w: int, *boxes: Box, code: int = evidence.INPAINTED) -> np.ndarray:
    marks = np.full((h, w), evidence.PHOTOGRAPHED, np.uint8)
    for x0, y0, x1, y1 in boxes:
        marks[y0:y1, x0:x1] = code
    return marks


def obedient(image: np.ndarray, hole: np.ndarray, guess: np.ndarray) -> tuple:
    """Stand in for a network that believes the guess."""
    return (image * (1 - hole) + guess * hole,)


def vain(image: np.ndarray, *_: np.ndarray) -> tuple:
    """Stand in for a network that repaints everything in white."""
    return (np.ones_like(image),)


def test_nothing_photographed_is_ever_changed() -> None:
    rng = np.random.default_rng(0)
    image = rng.integers(0, 256, (150, 130), np.uint8)
    marks = rng.integers(0, 5, (150, 130)).astype(np.uint8)
    given = elevation(image, marks)
    for fill in (inpaint, whole, low_memory):
        made = fill(given, vain)
        filled = holes(made.evidence)
        assert (made.image[~filled] == given.image[~filled]).all()
        assert (made.image[filled] == 255).all()
        assert (marks[made.evidence != marks] == evidence.SOFT_EDGE).all()
        assert filled[holes(marks)].all()


def test_an_elevation_without_a_hole_is_returned_as_it_is() -> None:
    given = elevation(front(90, 80), marked(90, 80))
    assert inpaint(given, vain) is given


def test_filling_twice_gives_the_same_bytes() -> None:
    given = elevation(front(200, 160), marked(200, 160, Box(40, 50, 90, 200)))
    first, second = (inpaint(given, obedient).image for _ in range(2))
    assert first.tobytes() == second.tobytes()


def test_low_memory_equals_whole_where_one_slice_covers_everything() -> None:
    given = elevation(front(160, 168), marked(160, 168, Box(60, 60, 100, 120)))
    assert (low_memory(given, obedient).image == whole(given, obedient).image).all()


def test_a_hidden_window_is_found_again_where_the_front_repeats() -> None:
    image = front(240, 216)
    marks = marked(240, 216, Box(80, 90, 130, 150))
    hole = holes(marks)
    made = inpaint(elevation(image, marks), obedient).image
    off = np.abs(made.astype(float) - image)[hole].mean()
    plain = np.abs(image[~hole].mean() - image[hole]).mean()
    assert off < 0.1 * plain


def test_what_is_no_facade_does_not_bleed_into_the_hole() -> None:
    marks = marked(120, 120, Box(0, 0, 120, 40), code=evidence.NOTHING)
    marks[40:60, 30:90] = evidence.INPAINTED
    image = np.full((120, 120), 90, np.uint8)
    dark = elevation(np.where(marks == evidence.NOTHING, 0, image), marks)
    sky = elevation(np.where(marks == evidence.NOTHING, 255, image), marks)
    made = [inpaint(given, obedient).image[holes(marks)] for given in (dark, sky)]
    assert (made[0] == made[1]).all()
    assert (np.abs(made[0].astype(int) - 90) <= 1).all()


def test_a_front_of_which_nothing_was_seen_is_filled_all_the_same() -> None:
    marks = np.full((40, 30), evidence.BEYOND_FRAME, np.uint8)
    made = inpaint(elevation(front(40, 30), marks), obedient).image
    assert made.shape == (40, 30)


def test_a_large_hole_shows_no_seam_between_slices() -> None:
    image = np.full((900, 1400), 128, np.uint8)
    marks = marked(900, 1400, Box(50, 50, 1350, 850))
    seen: list[tuple[int, int]] = []

    def moody(image: np.ndarray, *_: np.ndarray) -> tuple:
        seen.append(image.shape[2:])
        return (np.full_like(image, 0.1 * (-1) ** len(seen)),)

    chunk = (320, 440)
    made = low_memory(elevation(image, marks), moody, chunk=chunk).image
    made = made[60:840, 60:1340]
    assert len(seen) >= 4
    assert max(h for h, _ in seen) <= chunk[0]
    assert max(w for _, w in seen) <= chunk[1]
    steps = [np.abs(np.diff(made.astype(int), axis=axis)).max() for axis in (0, 1)]
    assert max(steps) <= 4  # a hard seam would be a step of 25 gray levels


@pytest.mark.parametrize("seed", range(5))
def test_slices_answer_for_every_hidden_texel(seed: int) -> None:
    rng = np.random.default_rng(seed)
    hole = np.zeros((700, 1500), bool)
    for _ in range(6):
        y, x = rng.integers(0, 700), rng.integers(0, 1500)
        hole[y : y + rng.integers(5, 300), x : x + rng.integers(5, 700)] = True
    covered = np.zeros_like(hole)
    for piece in slices(hole):
        assert piece.view.y1 - piece.view.y0 <= CHUNK_PX[0]
        assert piece.view.x1 - piece.view.x0 <= CHUNK_PX[1]
        covered[piece.cell.y0 : piece.cell.y1, piece.cell.x0 : piece.cell.x1] = True
    assert covered[hole].all()


def test_merged_boxes_do_not_overlap_and_cover_what_they_were() -> None:
    rng = np.random.default_rng(1)
    corners = rng.integers(0, 200, (30, 2))
    boxes = [Box(x, y, x + 25, y + 15) for x, y in corners.tolist()]
    apart = merged(boxes)
    for box in boxes:
        assert any(
            b.x0 <= box.x0 and b.y0 <= box.y0 and b.x1 >= box.x1 and b.y1 >= box.y1
            for b in apart
        )
    shared = [
        (a, b)
        for i, a in enumerate(apart)
        for b in apart[:i]
        if a.x0 < b.x1 and b.x0 < a.x1 and a.y0 < b.y1 and b.y0 < a.y1
    ]
    assert shared == []


def test_a_chunk_without_room_is_a_mistake() -> None:
    with pytest.raises(ValueError, match="no room"):
        slices(np.ones((10, 10), bool), context=200)


def test_memory_beyond_the_guess_grows_by_some_bytes_a_texel() -> None:
    marks = marked(3000, 3000, Box(1000, 1000, 1100, 1200))
    given = elevation(np.full((3000, 3000), 90, np.uint8), marks)
    tracemalloc.start()
    low_memory(given, obedient)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    # 100 bytes a texel of the guess, whose size is bounded, and 16 of the image.
    assert peak < 100 * GUESSED_PX + 16 * marks.size


def test_soft_edges_beside_the_hole_are_not_looked_at() -> None:
    image = np.full((80, 80), 100, np.uint8)
    image[38:41] = 255  # the rim of a white awning; above the ground floor
    marks = marked(80, 80, Box(0, 0, 80, 38))
    marks[38:41] = evidence.SOFT_EDGE
    given = elevation(image, marks)
    made = inpaint(replace(given), obedient).image
    assert (np.abs(made[marks == evidence.INPAINTED].astype(int) - 100) <= 1).all()
