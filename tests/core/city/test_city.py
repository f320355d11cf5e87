from dataclasses import astuple, replace

import numpy as np
import pytest
import shapely

from nostalgin_core import address
from nostalgin_core.block import block
from nostalgin_core.city import city, ways
from nostalgin_core.city.grounds import Grounds
from nostalgin_core.city.plot import Border, Move, Plot
from nostalgin_core.city.plot import plot as plot_of
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
    return plot_of(name, outlines, fronts)


def grounds(plots: list[Plot], moves: dict[str, Move]) -> list[shapely.Polygon]:
    return [
        shapely.Polygon(city.carried(moves[one.block], one.outlines_m[0]))
        for one in plots
    ]


def placed_plainly(
    plots: list[Plot], given: dict[str, Move] | None = None
) -> dict[str, Move]:
    """Look through all ways again at every step: the slow reader of the same rules."""
    moves = dict(given or {})
    every = ways.pairs(plots)
    failed = set()
    while len(moves) < len(plots):
        standing = {
            i: city.moved(p, moves[p.block])
            for i, p in enumerate(plots)
            if p.block in moves
        }
        for pair in every:
            _, _, index, other, side, there = pair
            if index in standing or other not in standing or pair in failed:
                continue
            (move,) = [
                *ways.ways(
                    plots[index].borders[side], standing[other].borders[there], {}
                ),
                None,
            ][:1]
            if move is not None and all(
                city.ground(city.moved(plots[index], move))
                .intersection(city.ground(one))
                .area
                <= 1.0
                for one in standing.values()
            ):
                moves[plots[index].block] = move
                break
            failed.add(pair)
        else:
            first = next(one for one in plots if one.block not in moves)
            right = [city.ground(one).bounds[2] for one in standing.values()]
            left = city.ground(first).bounds[0]
            east = max(right) - left + block.FALLBACK_GAP_M if right else 0.0
            moves[first.block] = Move(east_m=float(east))
    return moves


@pytest.mark.parametrize("seed", range(4))
def test_placing_by_heap_and_grid_equals_looking_through_everything_again(
    seed: int,
) -> None:
    rng = np.random.default_rng(seed)
    names = rng.choice(np.arange(10, 40), 9, replace=False)
    plots = [plot(str(n), int(rng.integers(1, 60)) * 2 + 1) for n in names]
    moves, plainly = city.places(plots), placed_plainly(plots)
    assert moves.keys() == plainly.keys()
    for name, move in moves.items():
        assert astuple(move) == pytest.approx(astuple(plainly[name]), abs=1e-6)


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
    assert abs(moves["14"].turn_rad) < 1e-6
    metres_a_number = (near.bounds[3] - near.bounds[1]) / 6
    assert far.centroid.y - near.centroid.y == pytest.approx(40 * metres_a_number)


def test_a_block_that_shares_no_street_stands_to_the_east() -> None:
    alone = plot("90", 501)
    renamed = Plot(
        "90",
        alone.outlines_m,
        tuple(
            Border(f"x{n}", "", "", one.start_m, one.end_m, one.numbers)
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
    turned = city.moved(other, quarter)
    straight = grounds([one, other], city.places([one, other]))
    again = grounds([one, turned], city.places([one, turned]))
    assert straight[1].symmetric_difference(again[1]).area < 1e-6


def neighbourhood(count: int) -> list[Plot]:
    """Lay out a square town of numbered streets and avenues, a block a name."""
    side = int(np.ceil(np.sqrt(count)))
    base = plot("10", 101)
    town = []
    for index in range(count):
        north, east = divmod(index, side)
        streets = {
            "west 10 street": f"{north} street",
            "1 avenue": f"{east + 1} avenue",
            "west 11 street": f"{north + 1} street",
            "2 avenue": f"{east} avenue",
        }
        first = 100 * east + 1
        numbers = {
            "west 10 street": (first, first + 60),
            "1 avenue": (20 * north + 1, 20 * north + 13),
            "west 11 street": (first + 61, first + 1),
            "2 avenue": (20 * north + 14, 20 * north + 2),
        }
        borders = tuple(
            replace(
                one,
                street=streets[one.street],
                before=streets[one.before],
                after=streets[one.after],
                numbers=numbers[one.street],
            )
            for one in base.borders
        )
        town.append(Plot(str(index), base.outlines_m, borders))
    return town


def test_a_town_by_its_streets_is_the_town() -> None:
    town = neighbourhood(30)
    moves = city.places(town)
    wide, deep = np.ptp(town[0].outlines_m[0], axis=0)
    for index, one in enumerate(town):
        north, east = divmod(index, 6)
        assert abs(moves[one.block].turn_rad) < 1e-6
        assert moves[one.block].north_m == pytest.approx(
            north * (deep + address.STREET_M), abs=1e-6
        )
        assert moves[one.block].east_m == pytest.approx(
            east * (wide + address.AVENUE_M), abs=1e-6
        )


def test_the_ways_to_try_grow_with_the_blocks_and_no_faster() -> None:
    few, many = neighbourhood(64), neighbourhood(400)
    a, b = len(ways.pairs(few)) / 64, len(ways.pairs(many)) / 400
    assert b < 1.4 * a
    assert b <= 4 * 2 * (2 * ways.NEAREST + 2 * ways.NEAREST + 1)


def test_what_is_looked_at_near_a_ground_does_not_grow_with_the_town() -> None:
    grounds = Grounds()
    boxes = [(x * 100.0, y * 70.0) for x in range(40) for y in range(40)]
    for x, y in boxes:
        grounds.add(shapely.box(x, y, x + 80, y + 50))
    near = [len(grounds.near((x, y, x + 110.0, y + 70.0))) for x, y in boxes]
    assert max(near) <= 4


@pytest.mark.parametrize("seed", range(3))
def test_a_grid_finds_what_looking_at_every_ground_finds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    grounds, every = Grounds(), []
    for size in 10 ** rng.uniform(0, 4, 200):
        x, y = rng.uniform(-3000, 3000, 2)
        one = shapely.box(x, y, x + size, y + size * rng.uniform(0.1, 1))
        meeting = [i for i, b in enumerate(every) if b.intersects(one)]
        assert grounds.near(one.bounds) == meeting
        found = [i for i, _ in grounds.overlapping(one)]
        assert found == [i for i in meeting if every[i].intersection(one).area > 1.0]
        grounds.add(one)
        every.append(one)


def test_given_blocks_stand_where_they_are_told_and_others_by_them() -> None:
    plots = [plot("10", 1), plot("11", 21), plot("12", 41)]
    there = Move(0.3, 500.0, -200.0)
    given = city.places(plots, given={"11": there})
    assert given["11"] == there
    free = city.places(plots)
    for name in ("10", "12"):
        corner = plots[0].outlines_m[0][:1]
        assert grounds([plots[0]], {"10": given[name]})[0].distance(
            grounds([plots[0]], {"10": there})[0]
        ) == pytest.approx(address.STREET_M)
        assert np.linalg.norm(
            city.carried(given[name], corner) - city.carried(there, corner)
        ) == pytest.approx(
            np.linalg.norm(
                city.carried(free[name], corner) - city.carried(free["11"], corner)
            )
        )


def test_a_street_is_as_wide_as_it_was_measured() -> None:
    plots = [plot("10", 1), plot("11", 21)]
    moves = city.places(plots, widths={"west 11 street": 31.0})
    south, north = grounds(plots, moves)
    assert south.distance(north) == pytest.approx(31.0)


def test_placing_a_turned_town_turns_it() -> None:
    town = neighbourhood(12)
    turn = Move(0.7, 40.0, 5.0)
    plain = city.places(town, given={"0": Move()})
    turned = city.places(town, given={"0": turn})
    for one in town:
        a = city.carried(turn, city.carried(plain[one.block], one.outlines_m[0]))
        b = city.carried(turned[one.block], one.outlines_m[0])
        assert np.allclose(a, b, atol=1e-6)
