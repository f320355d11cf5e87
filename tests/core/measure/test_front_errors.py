import numpy as np
import pytest

from nostalgin_core.measure.front_errors import errors

SIZE = (60, 100)
NOWHERE = np.zeros(SIZE, bool)


def _box(x0: int, y0: int, x1: int, y1: int) -> np.ndarray:
    mask = np.zeros(SIZE, bool)
    mask[y0:y1, x0:x1] = True
    return mask


LEFT, RIGHT = _box(10, 10, 30, 50), _box(30, 10, 50, 50)


def test_what_is_found_exactly_has_no_errors() -> None:
    told = errors([LEFT, RIGHT], [LEFT, RIGHT], NOWHERE)
    assert told.fates == ("found", "found")
    assert told.holders == (0, 1)
    assert told.walls == (False, False)


@pytest.mark.parametrize(
    ("found", "fate"),
    [
        ([], "missed"),
        ([_box(10, 10, 18, 50)], "missed"),
        ([_box(8, 10, 50, 50)], "merged"),
        ([_box(10, 10, 19, 50), _box(19, 10, 28, 50)], "split"),
        ([_box(10, 0, 30, 59) | _box(0, 0, 10, 59)], "walled"),
        ([_box(10, 10, 30, 40)], "found"),
    ],
)
def test_each_loss_has_its_name(found: list[np.ndarray], fate: str) -> None:
    assert errors(found, [LEFT, RIGHT], NOWHERE).fates[0] == fate


def test_a_claim_that_is_mostly_on_no_front_is_a_wall_but_not_on_a_far_row() -> None:
    wall = _box(45, 10, 70, 50)
    assert errors([wall], [LEFT, RIGHT], NOWHERE).walls == (True,)
    assert errors([wall], [LEFT, RIGHT], _box(50, 0, 90, 60)).walls == (False,)


def test_without_labels_every_claim_is_a_wall_and_nothing_is_missed() -> None:
    told = errors([LEFT], [], NOWHERE)
    assert told.fates == ()
    assert told.walls == (True,)
