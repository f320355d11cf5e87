"""A front that its own photograph does not show well wears what a neighbour's saw."""

from dataclasses import replace

from nostalgin_core.block.lent import lent
from nostalgin_core.records import Assignment
from nostalgin_core.views import Claim
from tests.core.listed import front, seen

FRONTS = (front("a", rank=0), front("b", rank=1))
OWN = seen("a")
BESIDE = replace(OWN, facade=1, target=False, target_score=0.02)
GIVEN = Assignment("9-a-0", "a", 0, 0.5)
TOLD = Claim("9-b-0", "a", 1, 0.9, "order")


def test_a_front_without_a_photograph_wears_its_neighbour_s() -> None:
    (one,) = lent(FRONTS, [GIVEN], [TOLD], [OWN, BESIDE])
    assert (one.front_id, one.photo, one.facade, one.lent) == ("9-b-0", "a", 1, True)
    assert 0 < one.score < 1


def test_one_whose_own_photograph_is_mostly_hidden_does_too() -> None:
    hidden = replace(OWN, photo="b", photographed=0.1)
    own = Assignment("9-b-0", "b", 0, 0.4)
    (one,) = lent(FRONTS, [GIVEN, own], [TOLD], [OWN, BESIDE, hidden])
    assert one.photo == "a"


def test_one_that_its_own_photograph_shows_well_borrows_nothing() -> None:
    clear = replace(OWN, photo="b")
    own = Assignment("9-b-0", "b", 0, 0.4)
    assert not lent(FRONTS, [GIVEN, own], [TOLD], [OWN, BESIDE, clear])


def test_what_is_worn_already_or_shows_nothing_is_not_lent() -> None:
    worn = replace(TOLD, facade=0)
    assert not lent(FRONTS, [GIVEN], [worn], [OWN, BESIDE])
    tiny = replace(BESIDE, area_px=100.0)
    assert not lent(FRONTS, [GIVEN], [TOLD], [OWN, tiny])


def test_the_likelier_and_clearer_of_two_is_lent() -> None:
    other = replace(BESIDE, photo="c")
    doubt = replace(TOLD, photo="c", probability=0.82)
    for order in ([TOLD, doubt], [doubt, TOLD]):
        (one,) = lent(FRONTS, [GIVEN], order, [OWN, BESIDE, other])
        assert one.photo == "a"
