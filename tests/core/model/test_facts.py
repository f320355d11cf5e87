import numpy as np

from nostalgin_core.model import facts
from tests.core import sample_block as sample


def test_facts_have_a_row_a_building_in_its_order() -> None:
    settled = sample.settled("1")
    table = facts.table(settled)
    assert table["id"] == [one.building_id for one in settled.block.buildings]
    assert {len(column) for column in table.values()} == {len(table["id"])}
    row = table["id"].index("1-9")
    assert table["address"][row] == "101-103 West 1 Street; 1-3 First Avenue"
    assert table["photo"][row] == table["photos"][row] == "photo-1-9"
    bare = table["id"].index("1-5")
    assert (table["photo"][bare], table["assumed"][bare]) == ("", "yes")


def test_measures_are_those_of_the_cuboids() -> None:
    block = sample.settled("1").block
    measures = facts.measures(block)
    assert measures["height_m"].tolist() == [
        np.float32(one.height_m) for one in block.buildings
    ]
    first = [one.footprint_m[:2] for one in block.buildings]
    np.testing.assert_allclose(
        measures["width_m"], [np.hypot(*(b - a)) for a, b in first], rtol=1e-6
    )
