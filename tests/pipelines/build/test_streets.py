"""A block that a street cuts in two is told how wide that is, and no other is."""

from dataclasses import replace

from nostalgin_core.records import Front
from pipelines.build.streets import Streets
from pipelines.index.plan import BlockTask


def front(ring: int, side: int, street: str, address: str) -> Front:
    return Front(
        front_id=f"9-{ring}{side}-{side}",
        block="9",
        lot=f"{ring}{side}",
        ring=ring,
        side=side,
        rank=side,
        street=street,
        address=address,
        width_m=20.0,
        depth_m=None,
        width_assumed=False,
    )


CUT = BlockTask(
    "9",
    (
        front(0, 0, "South Street", "147"),
        front(0, 1, "Broad  Way", "1431"),
        front(1, 0, "South Street", "119"),
        front(1, 1, "Broad  Way", "1434"),
    ),
    photos=(),
    credit="",
)
WHOLE = replace(CUT, fronts=CUT.fronts[:2])


def test_what_lies_between_two_outlines_is_the_street_that_cuts() -> None:
    told = Streets(gaps_m={"9": 31.0}).told(CUT)
    assert told.widths_m == (("broad way", 31.0),)


def test_a_table_of_streets_goes_before_outlines() -> None:
    told = Streets({"broad way": 24.0, "south street": 18.0}, {"9": 31.0}).told(CUT)
    assert told.widths_m == (("broad way", 24.0),)


def test_a_block_of_one_ring_and_one_of_which_nothing_is_told_stay_as_they_are() -> (
    None
):
    assert Streets({"broad way": 24.0}, {"9": 31.0}).told(WHOLE) is WHOLE
    assert Streets(gaps_m={"8": 31.0}).told(CUT) is CUT
    assert Streets().told(CUT) is CUT
    assert Streets({"elm street": 10.0}).told(CUT).widths_m == ()
