import numpy as np
import pytest

from nostalgin_core.city import Anchor, Plot
from nostalgin_core.records import Front
from pipelines.index import Anchors
from pipelines.site.placing import placing, plot_of, spot

RING = [[0.0, 0.0], [80.0, 0.0], [80.0, 50.0], [0.0, 50.0]]


def plots() -> list[Plot]:
    return [
        plot_of({"block": name, "outline_m": [RING]}, fronts(name))
        for name in ("10", "11")
    ]


def fronts(block: str) -> list[Front]:
    made = []
    for name, streets in (("10", "ABCD"), ("11", "CEFG")):
        for side, street in enumerate(streets):
            odd = (name == "10") == (street == "C")
            front = Front(
                f"{name}-{side}", name, "1", 0, side, side, street,
                "31" if odd else "30", 80.0, None, width_assumed=False,
            )  # fmt: skip
            made.append(front)
    return [one for one in made if one.block == block]


def test_blocks_without_anchors_have_no_place_on_the_globe() -> None:
    found = placing(plots(), Anchors())
    assert found.origin is None
    assert found.spots == {}
    assert [row["how"] for row in found.rows] == ["streets", "streets"]
    assert "longitude_deg" not in spot(found.rows[0])


def test_one_anchor_puts_every_block_on_the_globe() -> None:
    here = Anchor(-73.986, 40.7555, 119.0)
    found = placing(plots(), Anchors({"10": here}))
    assert set(found.spots) == {"10", "11"}
    assert [row["how"] for row in found.rows] == ["point", "streets"]
    assert spot(found.rows[0])["bearing_deg"] == pytest.approx(119.0)
    apart = np.hypot(
        *(found.rows[0][n] - found.rows[1][n] for n in ("east_m", "north_m"))
    )
    assert apart > 50


def test_a_measured_street_is_that_wide() -> None:
    narrow = placing(plots(), Anchors(widths_m={"c": 10.0})).moves["11"]
    wide = placing(plots(), Anchors(widths_m={"c": 40.0})).moves["11"]
    apart = np.hypot(wide.east_m - narrow.east_m, wide.north_m - narrow.north_m)
    assert apart == pytest.approx(30.0)


def test_blocks_on_one_another_are_told() -> None:
    here = Anchor(-73.986, 40.7555, 90.0)
    found = placing(plots(), Anchors({"10": here, "11": here}))
    assert any("stand on one another" in note for note in found.notes)
