from dataclasses import replace

import numpy as np

from nostalgin_core import evidence
from nostalgin_core.inpaint.inpaint import inpaint
from nostalgin_core.inpaint.rim import HALO_PX, kept, marked, rim
from nostalgin_core.measure.inpainting import elevation
from nostalgin_core.records import Elevation

WALL, HAT = 100, 250


def obedient(image: np.ndarray, hole: np.ndarray, guess: np.ndarray) -> tuple:
    """Stand in for a network that believes the guess."""
    return (image * (1 - hole) + guess * hole,)


def person(*, alpha: float) -> Elevation:
    """Take a person in a white hat out of a plain wall, a soft edge round the hole."""
    marks = np.full((90, 80), evidence.PHOTOGRAPHED, np.uint8)
    marks[27:90, 27:53] = evidence.SOFT_EDGE
    marks[30:90, 30:50] = evidence.INPAINTED
    soft = marks == evidence.SOFT_EDGE
    share = np.where(soft, alpha, marks == evidence.PHOTOGRAPHED).astype(np.float32)
    image = np.round(share * WALL + (1 - share) * HAT).astype(np.uint8)
    image[marks == evidence.INPAINTED] = 0
    return replace(elevation(image, marks), alpha=share)


def test_no_outline_of_what_was_taken_out_remains() -> None:
    for alpha in (0.15, 0.3, 0.5):
        given = person(alpha=alpha)
        soft = given.evidence == evidence.SOFT_EDGE
        made = inpaint(given, obedient)
        assert np.abs(given.image[soft].astype(int) - WALL).min() > 50
        assert (np.abs(made.image.astype(int)[:50] - WALL) <= 2).all()
        assert (made.evidence[soft] == evidence.INPAINTED).all()


def test_photographed_texels_stay_bit_equal_beside_a_soft_edge() -> None:
    given = person(alpha=0.4)
    rng = np.random.default_rng(0)
    noise = rng.integers(0, 20, given.image.shape, np.uint8)
    given = replace(given, image=given.image - noise)
    seen = given.evidence == evidence.PHOTOGRAPHED
    made = inpaint(given, obedient)
    assert (made.image[seen] == given.image[seen]).all()
    assert (made.evidence[seen] == evidence.PHOTOGRAPHED).all()


def test_an_edge_that_is_the_fronts_alone_stays_as_it_was_photographed() -> None:
    given = person(alpha=evidence.SEEN)
    soft = given.evidence == evidence.SOFT_EDGE
    made = inpaint(given, obedient)
    assert (made.image[soft] == given.image[soft]).all()
    assert (made.evidence == given.evidence).all()


def test_the_photograph_comes_in_steadily_as_alpha_rises() -> None:
    share = kept(np.linspace(0, 1, 50, dtype=np.float32))
    assert (np.diff(share) >= 0).all()
    assert share[0] == 0
    assert share[-1] == 1


def test_edges_at_the_sky_and_far_from_the_hole_are_left_alone() -> None:
    marks = np.full((60, 60), evidence.PHOTOGRAPHED, np.uint8)
    marks[:5] = evidence.NOTHING
    marks[5:8] = evidence.SOFT_EDGE
    marks[9:20, 20:30] = evidence.INPAINTED
    marks[50:53] = evidence.SOFT_EDGE
    edge = rim(marks, marks == evidence.INPAINTED)
    assert not edge.any()
    marks[20 + HALO_PX - 1] = evidence.SOFT_EDGE
    edge = rim(marks, marks == evidence.INPAINTED)
    assert edge[20 + HALO_PX - 1, 25]
    after = marked(marks, edge, np.zeros(marks.shape, np.float32))
    assert ((after != marks) == edge).all()
