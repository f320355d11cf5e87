import numpy as np
import pytest

from nostalgin_core.measure.inpainting import (
    Marks,
    Question,
    ask,
    mark,
    methods,
    summary,
)


def question(*, seed: int = 0) -> Question:
    y, x = np.mgrid[:90, :80]
    image = (100 + 50 * np.sin(x / 9) * np.sin(y / 11)).astype(np.uint8)
    known = np.ones(image.shape, bool)
    known[:10] = False
    return ask(image, known, rng=np.random.default_rng(seed))


def test_the_truth_scores_nought_and_white_on_black_a_hundred() -> None:
    asked = question()
    assert mark(asked.image, asked) == Marks(0, 0)
    black = asked._replace(image=np.zeros_like(asked.image))
    assert mark(np.full_like(asked.image, 255), black) == Marks(100, 100)


@pytest.mark.parametrize("seed", range(5))
def test_strokes_cover_the_papers_share_and_unknown_texels_are_not_scored(
    seed: int,
) -> None:
    asked = question(seed=seed)
    assert asked.hole[:10].all()
    assert not asked.scored[:10].any()
    assert 0.1 < asked.scored.mean() < 0.5


def test_every_method_keeps_what_is_known_and_beats_a_flat_fill() -> None:
    asked = question()
    flat = np.where(asked.hole, 128, asked.image).astype(np.uint8)
    for fill in methods(lambda _image, _hole, guess: (guess,)).values():
        hidden = np.where(asked.hole, 0, asked.image).astype(np.uint8)
        made = fill(hidden, asked.hole)
        assert (made[~asked.hole] == asked.image[~asked.hole]).all()
        assert mark(made, asked).l1 < mark(flat, asked).l1


def test_a_summary_is_the_mean_and_the_spread() -> None:
    mean, spread = summary([Marks(1, 4), Marks(3, 8)])
    assert mean == Marks(2, 6)
    assert spread == Marks(1, 2)
