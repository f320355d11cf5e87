import numpy as np
import pytest

from nostalgin_core.segment.answer import Nonsense, checked, probe

SHAPE = (128, 160)
SOUND = {
    "boxes": np.zeros((2, 4), np.float32),
    "labels": np.array([1, 6]),
    "scores": np.array([0.9, 0.2], np.float32),
    "masks": np.zeros((2, 46, 46), np.float32),
    "pixels": np.zeros((4, 32, 40), np.float32),
    "indoors": np.zeros((1, 4, 5), np.float32),
}
NAN = np.full((2, 4), np.nan, np.float32)


def test_a_sound_answer_is_taken_as_it_is() -> None:
    assert checked(tuple(SOUND.values()), SHAPE).labels is SOUND["labels"]


@pytest.mark.parametrize("count", [4, 5])
def test_a_network_of_before_the_branch_or_the_head_is_told_to_be_older(
    count: int,
) -> None:
    with pytest.raises(Nonsense, match=rf"gives {count} outputs .* older"):
        checked(tuple(SOUND.values())[:count], SHAPE)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("boxes", np.zeros((2, 3), np.float32)),
        ("boxes", np.zeros((9, 4), np.float32)),
        ("boxes", NAN),
        ("labels", np.array([1, 77])),
        ("labels", np.array([0, 1])),
        ("scores", np.zeros(3, np.float32)),
        ("masks", np.zeros((2, 46), np.float32)),
        ("masks", np.zeros((2, 46, 45), np.float32)),
        ("pixels", np.zeros((4, 32, 39), np.float32)),
        ("indoors", np.zeros((4, 5), np.float32)),
    ],
)
def test_nonsense_is_named(name: str, value: np.ndarray) -> None:
    answer = SOUND | {name: value}
    with pytest.raises(Nonsense, match=name):
        checked(tuple(answer.values()), SHAPE)


def test_a_network_is_asked_before_photographs_are() -> None:
    with pytest.raises(Nonsense):
        probe(lambda image: (image,))
