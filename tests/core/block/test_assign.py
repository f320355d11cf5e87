from dataclasses import replace

import pytest

from nostalgin_core.block import assign
from nostalgin_core.records import Assignment, Rejection, Seen
from tests.core.listed import front, seen

FRONTS = (
    front("a", 0, 0),
    front("b", 0, 1),
    front("b", 1, 2, address=""),
    front("c", 1, 3),
)
LEFT = seen()
RIGHT = replace(LEFT, facade=1, left_px=300.0)


def given(*seen: Seen, names: tuple[str, ...] = ("9-b-0",)) -> list[tuple[str, int]]:
    done = assign.assign(FRONTS, {"p": names}, seen)
    return [(one.front_id, one.facade) for one in done if isinstance(one, Assignment)]


def rejected(*seen: Seen, names: tuple[str, ...] = ("9-b-0",)) -> Rejection:
    (one,) = assign.assign(FRONTS, {"p": names}, seen)
    assert isinstance(one, Rejection)
    return one


def test_a_lot_s_target_is_its_front() -> None:
    assert given(LEFT, names=("9-a-0",)) == [("9-a-0", 0)]


def test_two_targets_at_a_corner_stand_in_the_order_of_the_ring() -> None:
    assert given(LEFT, RIGHT) == [("9-b-0", 0), ("9-b-1", 1)]


def test_their_order_in_the_photo_counts_not_their_index() -> None:
    swapped = replace(LEFT, left_px=500.0)
    assert given(swapped, RIGHT) == [("9-b-0", 1), ("9-b-1", 0)]


def test_one_target_of_a_corner_lot_is_the_front_with_the_address() -> None:
    assert given(LEFT) == [("9-b-0", 0)]


def test_across_the_start_of_the_ring_the_last_side_is_the_left_one() -> None:
    around = (front("x", 0, 0), front("x", 3, 9, address=""), front("y", 1, 3))
    done = assign.assign(around, {"p": ["9-x-0"]}, [LEFT, RIGHT])
    assert [
        (one.front_id, one.facade) for one in done if isinstance(one, Assignment)
    ] == [
        ("9-x-3", 0),
        ("9-x-0", 1),
    ]


def test_neighbours_in_the_photo_are_not_the_lot() -> None:
    neighbour = replace(LEFT, facade=3, target=False, area_px=300_000.0)
    assert given(neighbour, RIGHT, names=("9-a-0",)) == [("9-a-0", 1)]


def test_of_several_targets_of_a_lot_with_one_front_the_best_is_given() -> None:
    faint = replace(LEFT, facade=4, target_score=0.6)
    assert given(faint, RIGHT, names=("9-a-0",)) == [("9-a-0", 1)]


def test_every_photo_of_a_lot_is_scored() -> None:
    other = replace(LEFT, photo="q", photographed=0.4)
    done = assign.assign(FRONTS, {"p": ["9-a-0"], "q": ["9-a-0"]}, [LEFT, other])
    assert [one.front_id for one in done if isinstance(one, Assignment)] == [
        "9-a-0"
    ] * 2
    assert done[0].score > done[1].score  # type: ignore[union-attr]


@pytest.mark.parametrize(
    "worse",
    [
        {"score": 0.5},
        {"target_score": 0.5},
        {"photographed": 0.3},
        {"stretched": 0.7},
        {"sharpness": 1.0},
        {"area_px": 2_000.0},
        {"aspect_sd": 0.5},
    ],
)
def test_whatever_is_worse_lowers_the_score(worse: dict[str, float]) -> None:
    assert 0 < assign.score(replace(LEFT, **worse)) < assign.score(LEFT) < 1


def test_what_shows_no_front_is_rejected_with_its_reason() -> None:
    assert rejected().reason == "no facade"
    assert rejected(replace(LEFT, target=False)).reason == "no target"
    assert rejected(replace(LEFT, area_px=50.0)).reason == "no usable target"
    assert rejected(replace(LEFT, aspect=40.0)).reason == "no usable target"
    assert rejected(LEFT, names=("9-z-0",)).reason == "no such front"


def test_two_sure_targets_make_a_corner_building() -> None:
    candidates = {"p": ["9-b-0"]}
    assert assign.two_fronted(FRONTS, candidates, [LEFT, RIGHT]) == {"9-b"}
    assert not assign.two_fronted(FRONTS, candidates, [LEFT])
    unsure = replace(RIGHT, target_score=0.2)
    assert not assign.two_fronted(FRONTS, candidates, [LEFT, unsure])


def test_a_party_wall_makes_no_corner_building() -> None:
    candidates = {"p": ["9-b-0"]}
    known = [
        replace(one, width_m=8.0, depth_m=24.0, width_assumed=False)
        for one in FRONTS
        if one.front_id == "9-b-0"
    ]
    right = replace(RIGHT, aspect=3.0 * LEFT.aspect)
    assert assign.two_fronted(known, candidates, [LEFT, right]) == {"9-b"}
    wall = replace(RIGHT, aspect=LEFT.aspect)
    assert not assign.two_fronted(known, candidates, [LEFT, wall])
    unlisted = [replace(one, depth_m=None) for one in known]
    behind = replace(RIGHT, target_score=0.45)  # the board is before the other one
    assert not assign.two_fronted(unlisted, candidates, [LEFT, behind])
