import numpy as np
import pytest

from nostalgin_core.rectify import orient, upright, vanish
from tests.core.rectify.test_upright import lines_of

TRUE = np.array([0.0, 0.01, 0.15, -0.5, 0.9])


def shown(front: int, *, count: int = 40) -> orient.Signal:
    """Make the lines that speak for a front: its own level ones and verticals."""
    lines = np.vstack(
        [
            lines_of(TRUE, front + 1, count, seed=front, sd=2e-4),
            lines_of(TRUE, 0, 20, seed=front + 9, sd=2e-4),
        ]
    )
    ones = np.ones(len(lines))
    return orient.Signal(lines, lines, ones, 700 * vanish.lengths(lines))


def world(*thetas: float, sd: tuple[float, float]) -> upright.Upright:
    """Make a world with the true camera and given azimuths."""
    covariance = np.diag([1e-4, 1e-4, 1e-4, *np.square(sd)])
    parameters = np.array([*TRUE[:3], *thetas])
    return upright.Upright(parameters, covariance, np.full(3, 20.0))


@pytest.mark.parametrize("wrong", [-0.3, -0.05, 0.2])
def test_a_front_that_started_wrong_turns_to_its_own_lines(wrong: float) -> None:
    started = world(TRUE[3] + wrong, TRUE[4], sd=(0.01, 0.01))
    chosen = orient.choose_again(started, [shown(0), shown(1)])
    np.testing.assert_allclose(np.sin(chosen[3:] - TRUE[3:]), 0, atol=0.02)


def test_a_front_whose_lines_agree_with_the_street_takes_its_direction() -> None:
    near = world(TRUE[3] + 0.03, TRUE[3], sd=(0.02, 0.001))
    chosen = orient.choose_again(near, [shown(0), shown(0)])
    assert chosen[3] == TRUE[3]


def test_a_front_without_level_lines_keeps_its_azimuth() -> None:
    nothing = shown(0, count=0)
    alone = world(0.4, TRUE[4], sd=(0.001, 0.01))
    assert orient.choose_again(alone, [nothing, shown(1)])[3] == 0.4
