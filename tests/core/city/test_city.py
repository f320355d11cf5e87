import numpy as np
import pytest
import shapely

from nostalgin_core import address
from nostalgin_core.block import block
from nostalgin_core.city import city
from nostalgin_core.city.city import Move, Plot
from nostalgin_core.records import Front

STREETS = {
    0: "West {} Street",
    1: "First Avenue",
    2: "West {} Street",
    3: "Second Avenue",
}


def front(name: str, side: int, number: int, width_m: float) -> Front:
    street = STREETS[side].format(int(name) + side // 2)
    return Front(
        front_id=f"{name}-{side}-{number}",
        block=name,
        lot=f"{side}{number}",
        ring=0,
        side=side,
        rank=4 * side + number % 4,
        street=street,
        address=str(number),
        width_m=width_m,
        depth_m=12.0,
        width_assumed=False,
    )


def plot(name: str, avenue: int, width_m: float = 80.0) -> Plot:
    """Make a block between two numbered streets; odd numbers stand to the south."""
    fronts = [
        front(name, 0, 131, width_m),
        front(name, 1, avenue, 25.0),
        front(name, 1, avenue + 6, 25.0),
        front(name, 2, 130, width_m),
        front(name, 3, avenue + 1, 50.0),
    ]
    outlines = block.block(name, fronts, [], {}).outline_m
    return city.plot(name, outlines, fronts)


def grounds(plots: list[Plot], moves: dict[str, Move]) -> list[shapely.Polygon]:
    return [
        shapely.Polygon(city.carried(moves[one.block], one.outlines_m[0]))
        for one in plots
    ]


def placed_plainly(plots: list[Plot]) -> dict[str, Move]:
    """Try every way again at every step: the slow reader of the same rules."""
    moves: dict[str, Move] = {}
    while len(moves) < len(plots):
        waiting = [one for one in plots if one.block not in moves]
        standing = [p for p in plots if p.block in moves]
        standing = [city._moved(one, moves[one.block]) for one in standing]
        ground = [city._ground(one) for one in standing]
        ways = (
            (one.block, move)
            for rule in city.RULES
            for one in waiting
            for other in standing
            for move in rule(one, other)
            if city._clear(city._moved(one, move), ground)
        )
        aside = (waiting[0].block, city._beside(waiting[0], ground))
        name, move = next(ways, aside)
        moves[name] = move
    return moves


@pytest.mark.parametrize("seed", range(4))
def test_trying_each_way_once_places_blocks_as_trying_all_again_does(seed: int) -> None:
    rng = np.random.default_rng(seed)
    names = rng.choice(np.arange(10, 40), 9, replace=False)
    plots = [plot(str(n), int(rng.integers(1, 60)) * 2 + 1) for n in names]
    moves = city.places(plots)
    assert moves == placed_plainly(plots)


def test_the_first_block_stays_where_it_is() -> None:
    assert city.places([plot("10", 1)])["10"] == Move()


def test_neighbours_face_each_other_over_their_street() -> None:
    plots = [plot("10", 1), plot("11", 21)]
    south, north = grounds(plots, city.places(plots))
    assert south.distance(north) == pytest.approx(address.STREET_M)
    assert north.centroid.y > south.centroid.y


def test_a_crossing_that_both_have_is_put_opposite() -> None:
    plots = [plot("10", 1, 80.0), plot("11", 21, 80.0)]
    south, north = grounds(plots, city.places(plots))
    assert south.bounds[0] == pytest.approx(north.bounds[0], abs=1e-6)
    assert south.bounds[2] == pytest.approx(north.bounds[2], abs=1e-6)


def test_a_block_further_along_an_avenue_is_as_far_as_its_numbers_say() -> None:
    plots = [plot("10", 1), plot("14", 41)]
    moves = city.places(plots)
    near, far = grounds(plots, moves)
    assert abs(moves["14"].turn_rad) < 1e-9
    metres_a_number = (near.bounds[3] - near.bounds[1]) / 6
    assert far.centroid.y - near.centroid.y == pytest.approx(40 * metres_a_number)


def test_a_block_that_shares_no_street_stands_to_the_east() -> None:
    alone = plot("90", 501)
    renamed = Plot(
        "90",
        alone.outlines_m,
        tuple(
            city.Border(f"x{n}", "", "", one.start_m, one.end_m, one.numbers)
            for n, one in enumerate(alone.borders)
        ),
    )
    plots = [plot("10", 1), renamed]
    west, east = grounds(plots, city.places(plots))
    assert east.bounds[0] - west.bounds[2] == pytest.approx(block.FALLBACK_GAP_M)


def test_no_block_stands_on_another() -> None:
    plots = [plot(str(name), 1 + 20 * (name - 10)) for name in (10, 11, 12, 15)]
    plots.append(
        plot("11", 21, 60.0).__class__("11b", plots[1].outlines_m, plots[1].borders)
    )
    placed = grounds(plots, city.places(plots))
    for index, a in enumerate(placed):
        assert all(a.intersection(b).area < 1.0 for b in placed[index + 1 :])


def test_a_turned_block_is_turned_back() -> None:
    one, other = plot("10", 1), plot("11", 21)
    quarter = Move(np.pi / 2, 300.0, -40.0)
    turned = city._moved(other, quarter)
    straight = grounds([one, other], city.places([one, other]))
    again = grounds([one, turned], city.places([one, turned]))
    assert straight[1].symmetric_difference(again[1]).area < 1e-6
