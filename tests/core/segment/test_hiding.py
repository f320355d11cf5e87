import numpy as np
import pytest

from nostalgin_core.records import Box, Category, Instance
from nostalgin_core.segment.hiding import EVEN, SURE, hiding, share_inside, widened

FRONT = Box(20, 10, 120, 210)


def _thing(category: Category, score: float, box: Box) -> Instance:
    shape = (box.y1 - box.y0, box.x1 - box.x0)
    return Instance(category, score, box, np.ones(shape, np.float32))


def _front() -> Instance:
    return _thing("facade", 0.9, FRONT)


def test_an_unsure_sign_inside_a_front_is_painted_on_it() -> None:
    sign = _thing("other", SURE - 0.01, Box(40, 50, 80, 70))
    assert [one.category for one in hiding([_front(), sign])] == ["facade"]


def test_a_sure_sign_stands_before_the_front() -> None:
    sign = _thing("other", SURE, Box(40, 50, 80, 70))
    assert sign in hiding([_front(), sign])


@pytest.mark.parametrize(
    "box", [Box(60, 150, 66, 260), Box(100, 50, 160, 70), Box(150, 50, 170, 90)]
)
def test_what_reaches_out_of_the_front_hides_it(box: Box) -> None:
    post = _thing("other", 0.2, box)
    assert post in hiding([_front(), post])


@pytest.mark.parametrize("category", ["placard", "vegetation", "facade"])
def test_other_kinds_are_kept_as_they_are(category: Category) -> None:
    thing = _thing(category, 0.2, Box(40, 50, 80, 70))
    assert thing in hiding([_front(), thing])


@pytest.mark.parametrize("category", ["person", "vehicle"])
def test_people_and_cars_grow_and_never_shrink(category: Category) -> None:
    ramp = np.linspace(0, 1, 60, dtype=np.float32).reshape(6, 10)
    thin = Instance(category, 0.3, Box(40, 50, 50, 56), ramp)
    (wide,) = hiding([thin])
    assert (wide.probability >= ramp).all()
    assert (wide.probability > 0.5).sum() > (ramp > 0.5).sum()


def test_the_even_probability_becomes_one_half_and_order_is_kept() -> None:
    values = np.array([[0.0, EVEN / 2, EVEN, 0.7, 1.0]], np.float32)
    wide = widened(Instance("person", 0.5, Box(0, 0, 5, 1), values)).probability
    np.testing.assert_allclose(wide[0, [0, 2, 4]], [0, 0.5, 1], atol=1e-6)
    assert (np.diff(wide[0]) > 0).all()
    assert wide.dtype == np.float32


def test_the_share_inside_is_of_the_thing_not_of_its_box() -> None:
    half = np.zeros((10, 10), np.float32)
    half[:, 5:] = 0.9
    thing = Instance("other", 0.3, Box(15, 50, 25, 60), half)
    assert share_inside(thing, _front()) == 1.0
    assert share_inside(_thing("other", 0.3, thing.box), _front()) == 0.5
    assert share_inside(_thing("other", 0.3, Box(0, 0, 9, 9)), _front()) == 0.0
