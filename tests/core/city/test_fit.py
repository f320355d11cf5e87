import numpy as np
import pytest
import shapely

from nostalgin_core.city.fit import fit, nearest, quarters
from nostalgin_core.city.plot import Move, carried
from tests.core.city.plain_fit import plain_fit

# a block that Broadway cuts aslant, anticlockwise from the south west
RING = np.array([[0.0, 0.0], [240.0, 0.0], [240.0, 61.0], [25.0, 61.0]])
ADRIFT_M = 4.0  # a wrong turn that finds no hold ends wherever rounding drives it
TURNED = [Move(0.5, 300.0, -120.0), Move(-2.9, -40.0, 77.0), Move(1.6, 0.0, 0.0)]


def off(found: Move, true: Move) -> float:
    apart = carried(found, RING) - carried(true, RING)
    return float(np.hypot(*apart.T).max())


@pytest.mark.parametrize("true", TURNED)
def test_a_ring_finds_its_own_outline_again(true: Move) -> None:
    outline = [carried(true, RING)]
    best = fit([RING], outline, quarters([RING], outline))[0]
    assert off(best.move, true) < 0.01
    assert best.misfit_m < 0.01
    assert best.agreeing == 1.0


def test_turning_the_outline_turns_the_fit() -> None:
    ragged = RING + np.random.default_rng(1).normal(0, 1.0, RING.shape)
    plain = fit([RING], [ragged], [0.0])[0].move
    for turn in TURNED:
        there = fit([RING], [carried(turn, ragged)], [turn.turn_rad])[0].move
        again = carried(turn, carried(plain, RING))
        assert np.allclose(carried(there, RING), again, atol=1e-3)


def test_an_end_that_the_map_cuts_off_pulls_at_nothing() -> None:
    true = TURNED[0]
    cut = shapely.Polygon(RING) & shapely.box(-10, -10, 205, 80)
    outline = [carried(true, shapely.get_coordinates(cut.exterior)[:-1])]
    best = fit([RING], outline, [true.turn_rad + 0.05])[0]
    assert off(best.move, true) < 1.0


def test_a_yard_open_to_the_street_pulls_at_nothing() -> None:
    true = TURNED[1]
    open_yard = shapely.Polygon(RING) - shapely.box(100, 20, 130, 80)
    outline = [carried(true, shapely.get_coordinates(open_yard.exterior)[:-1])]
    best = fit([RING], outline, [true.turn_rad - 0.05])[0]
    assert off(best.move, true) < 0.5


def test_two_rings_find_the_two_parts_that_a_street_leaves() -> None:
    other = np.array([[-90.0, 0.0], [-30.0, 0.0], [-5.0, 61.0], [-90.0, 61.0]])
    rings = [RING, other]
    outline = [carried(TURNED[2], ring) for ring in rings]
    best = fit(rings, outline, quarters(rings, outline))[0]
    assert off(best.move, TURNED[2]) < 0.01


@pytest.mark.parametrize("seed", range(6))
def test_all_turns_together_give_what_each_gives_alone(seed: int) -> None:
    rng = np.random.default_rng(seed)
    other = np.array([[-90.0, 0.0], [-30.0, 0.0], [-5.0, 61.0], [-90.0, 61.0]])
    rings = [RING, other][: 1 + seed % 2]
    true = Move(rng.uniform(-3, 3), *rng.uniform(-3000, 3000, 2))
    outline = [carried(true, r + rng.normal(0, 1.5, r.shape)) for r in rings]
    turns = quarters(rings, outline)
    together, alone = fit(rings, outline, turns), plain_fit(rings, outline, turns)
    assert off(together[0].move, alone[0].move) < 1e-4
    costs = zip(together, alone, strict=True)
    near = [one for one in costs if one[1].cost_m < ADRIFT_M]
    assert near
    for one, other in near:
        assert one.cost_m == pytest.approx(other.cost_m, abs=1e-4)
        assert one.misfit_m == pytest.approx(other.misfit_m, abs=1e-3)


def test_the_nearest_turn_is_found_round_the_circle() -> None:
    assert nearest([0.1, 3.0], -3.1) == 3.0


def test_nothing_fits_nothing() -> None:
    with pytest.raises(ValueError, match="no rings"):
        fit([RING], [], [0.0])
