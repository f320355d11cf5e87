"""A photograph that its neighbours' contradict is taken back, and its lot is named."""

from dataclasses import replace

from nostalgin_core.block.astray import outvoted
from nostalgin_core.records import Assignment, Front, Rejection
from nostalgin_core.views import Claim
from tests.core.block.test_lent import FRONTS, OWN

FILED = {"a": ["9-a-0"]}
GIVEN = Assignment("9-a-0", "a", 0, 0.5)
LOOKS = Claim("9-b-0", "a", 0, 0.95, "appearance")


def test_a_photograph_filed_under_another_lot_is_outvoted_and_its_lot_named() -> None:
    (one,) = outvoted([GIVEN], [LOOKS], FRONTS, FILED, [OWN])
    assert isinstance(one, Rejection)
    assert one.key == "a"
    assert "lot 9-b" in one.detail
    assert "95% sure" in one.detail
    assert "correct the photograph's lot" in one.detail


def test_of_two_targets_the_one_that_stays_is_named() -> None:
    stays = replace(GIVEN, front_id="9-a-1", facade=1)
    one, two = outvoted([GIVEN, stays], [LOOKS], FRONTS, FILED, [OWN])
    assert isinstance(one, Rejection)
    assert "facade 1 stays its own lot's" in one.detail
    assert two == stays


def test_who_is_not_sure_outvotes_nobody() -> None:
    unsure = replace(LOOKS, probability=0.85)
    assert outvoted([GIVEN], [unsure], FRONTS, FILED, [OWN]) == (GIVEN,)


def test_order_alone_outvotes_nobody() -> None:
    by_order = replace(LOOKS, told="order")
    assert outvoted([GIVEN], [by_order], FRONTS, FILED, [OWN]) == (GIVEN,)


def test_its_own_lot_on_another_street_is_its_own() -> None:
    around = replace(LOOKS, front_id="9-a-1")
    assert outvoted([GIVEN], [around], FRONTS, FILED, [OWN]) == (GIVEN,)


def test_what_is_no_target_changes_nothing() -> None:
    beside = replace(OWN, target=False)
    assert outvoted([GIVEN], [LOOKS], FRONTS, FILED, [beside]) == (GIVEN,)
    no_front: tuple[Front, ...] = ()
    assert outvoted([], [LOOKS], no_front, {}, [OWN]) == ()
