import csv

import numpy as np
import pytest
from shapely.geometry import Polygon

from nostalgin_core import scenes
from tests.data import DATA, needs_data

SEEDS = (0, 1, 7)


def town(seed: int, blocks: int = 2) -> scenes.Neighbourhood:
    return scenes.neighbourhood(np.random.default_rng(seed), blocks=blocks)


@pytest.mark.parametrize("seed", SEEDS)
def test_footprints_never_overlap(seed: int) -> None:
    for block in town(seed).blocks:
        shapes = [Polygon(lot.footprint_m) for lot in block.lots]
        for k, one in enumerate(shapes):
            for other in shapes[k + 1 :]:
                assert one.intersection(other).area < 1e-9


@pytest.mark.parametrize("seed", SEEDS)
def test_neighbours_share_a_party_wall(seed: int) -> None:
    for block in town(seed).blocks:
        shapes = [Polygon(lot.footprint_m) for lot in block.lots]
        for one, other in zip(shapes, [*shapes[1:], shapes[0]], strict=True):
            assert one.intersection(other).length > 5.0


@pytest.mark.parametrize("seed", SEEDS)
def test_fronts_go_anticlockwise_round_the_whole_block(seed: int) -> None:
    for block in town(seed).blocks:
        walls = {
            wall.front.rank: wall
            for lot in block.lots
            for wall in lot.walls
            if wall.front
        }
        ring = [walls[rank] for rank in range(len(walls))]
        for one, other in zip(ring, [*ring[1:], ring[0]], strict=True):
            assert one.end_m == pytest.approx(other.start_m)
        outline = Polygon([wall.start_m for wall in ring])
        assert outline.exterior.is_ccw
        west, south, east, north = block.corner_m
        assert outline.area == pytest.approx((east - west) * (north - south))


@pytest.mark.parametrize("seed", SEEDS)
def test_footprints_are_anticlockwise_and_start_at_the_first_front(seed: int) -> None:
    for block in town(seed).blocks:
        for lot in block.lots:
            assert Polygon(lot.footprint_m).exterior.is_ccw
            assert tuple(lot.footprint_m[0]) == lot.walls[0].start_m
            assert lot.walls[0].front is not None


def test_sides_rise_with_rank() -> None:
    for block in town(3).blocks:
        sides = [front.side for front in block.fronts]
        assert sides == sorted(sides)
        assert set(sides) == {0, 1, 2, 3}


def test_house_numbers_are_ordered_along_every_side() -> None:
    for block in town(5).blocks:
        for side in range(4):
            numbers = [
                int(front.address.split("-")[0])
                for front in block.fronts
                if front.side == side
            ]
            assert numbers == sorted(numbers, reverse=side in (0, 3))


def test_the_two_fronts_of_a_corner_are_the_same_house() -> None:
    for block in town(2).blocks:
        for lot in block.lots:
            styles = [wall.style for wall in lot.walls if wall.style]
            assert len({style.seed for style in styles}) == 1
            assert len({style.height_m for style in styles}) == 1


def test_the_same_seed_builds_the_same_town() -> None:
    one, other = scenes.catalogue_rows(town(4)), scenes.catalogue_rows(town(4))
    assert one == other
    assert one != scenes.catalogue_rows(town(6))


@pytest.mark.parametrize("seed", range(8))
def test_a_town_has_a_photo_count_fit_for_a_demo(seed: int) -> None:
    rows = scenes.catalogue_rows(town(seed))
    assert 20 <= len(rows) <= 32
    assert len({row["File Name "] for row in rows}) == len(rows)


def test_one_lot_is_ruined_and_one_was_photographed_thrice() -> None:
    lots = [lot for block in town(0).blocks for lot in block.lots]
    assert sum(lot.ruined for lot in lots) == 1
    assert max(lot.photos for lot in lots) == 3


def test_too_many_blocks_are_refused() -> None:
    with pytest.raises(ValueError, match="blocks must be"):
        town(0, blocks=9)


def test_frontages_are_written_in_feet_and_inches() -> None:
    assert scenes.catalogue.feet_inches(18.05) == "59.03"
    assert scenes.catalogue.feet_inches(0.3048 * 60) == "60.00"


@needs_data
def test_the_catalogue_has_the_real_catalogues_columns() -> None:
    with (DATA / "taxphotos" / "catalogue.csv").open(newline="") as file:
        header = next(csv.reader(file))
    assert list(scenes.catalogue_rows(town(0))[0]) == header
