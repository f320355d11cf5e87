"""A street of known fronts is photographed, and each facade must find its own."""

import itertools
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest

from nostalgin_core.records import Front, Standpoint
from nostalgin_core.views import Alike, Claim, Stretch, claimed, stretch
from tests.core import listed

WIDTHS_M = (7.6, 6.1, 15.2, 7.6, 9.1, 30.0, 6.1, 12.2)


def ring(widths_m: Sequence[float] = WIDTHS_M) -> list[Front]:
    """Build a block with the same fronts on all four sides, odd numbers rising."""
    return [
        listed.front(
            str(10 * side + i),
            side,
            side * len(widths_m) + i,
            width_m=width_m,
            address=str(2 * i + 1),
        )
        for side in range(4)
        for i, width_m in enumerate(widths_m)
    ]


def photographed(
    fronts: Sequence[Front],
    shown: Sequence[int],
    target: int,
    *,
    photo: str = "p",
    camera_m: float = 15.0,
    seed: int = 0,
) -> list[Stretch]:
    """Photograph fronts of one side, by rank, a few per cent off."""
    rng = np.random.default_rng(seed)
    starts_m = np.cumsum([0.0, *(one.width_m for one in fronts)])
    return [
        Stretch(
            photo=photo,
            facade=facade,
            left=(starts_m[rank] + rng.normal(0, 0.2)) / camera_m,
            right=(starts_m[rank + 1] + rng.normal(0, 0.2)) / camera_m,
            heading_deg=20.0 + rng.normal(0, 1),
            left_px=100.0 * facade,
            target_score=0.99 if rank == target else 0.03,
            score=0.99,
        )
        for facade, rank in enumerate(shown)
    ]


def lots(claims: Sequence[Claim]) -> dict[int, str]:
    return {one.facade: one.front_id for one in claims}


@pytest.mark.parametrize("seed", range(8))
def test_neighbours_stand_left_and_right_as_along_the_ring(seed: int) -> None:
    fronts = ring()
    seen = photographed(fronts, (2, 3, 4, 5), 3, seed=seed)
    claims = claimed(fronts, {"p": ["9-3-0"]}, seen)
    assert lots(claims) == {0: "9-2-0", 1: "9-3-0", 2: "9-4-0", 3: "9-5-0"}
    assert {one.facade: one.told for one in claims}[1] == "own"
    assert all(one.told == "order" for one in claims if one.facade != 1)


def test_a_front_that_was_not_found_leaves_a_gap_as_wide() -> None:
    fronts = ring()
    claims = claimed(fronts, {"p": ["9-1-0"]}, photographed(fronts, (1, 3, 4), 1))
    assert lots(claims) == {0: "9-1-0", 1: "9-3-0", 2: "9-4-0"}


def test_a_house_across_the_street_is_no_front_of_the_ring() -> None:
    fronts = ring()
    *own, last = photographed(fronts, (5, 6, 7, 8), 6)
    away = replace(last, heading_deg=-70.0)
    claims = claimed(fronts, {"p": ["9-6-0"]}, [*own, away])
    assert lots(claims) == {0: "9-5-0", 1: "9-6-0", 2: "9-7-0"}


def street_of(
    fronts: Sequence[Front], targets: Sequence[int], *, doubt: float = 0.0
) -> tuple[dict[str, list[str]], list[Stretch]]:
    """Photograph one side: each target with a neighbour on either side."""
    filed, seen = {}, []
    for target in targets:
        photo = f"p{target}"
        filed[photo] = [fronts[target].front_id]
        shown = (target - 1, target, target + 1)
        strip = photographed(fronts, shown, target, photo=photo, seed=target)
        seen += [
            replace(one, target_score=max(0.03, one.target_score - doubt))
            for one in strip
        ]
    return filed, seen


def pairs_of(
    seen: Sequence[Stretch], same: Callable[[Stretch, Stretch], float]
) -> Alike:
    return {
        (a.texture, b.texture): same(a, b)
        for a, b in itertools.combinations(seen, 2)
        if a.photo != b.photo
    }


def shown_by(one: Stretch) -> int:
    """Tell the rank of the front that a facade of `street_of` shows."""
    return int(one.photo[1:]) - 1 + one.facade


def test_looks_tell_what_order_leaves_open() -> None:
    fronts = ring((7.6,) * 8)
    filed, seen = street_of(fronts, (2, 3, 4), doubt=0.35)
    alike = pairs_of(seen, lambda a, b: 0.97 if shown_by(a) == shown_by(b) else 0.05)
    before, after = (claimed(fronts, filed, seen, one) for one in (None, alike))
    assert len(after) > len(before)
    assert {one.told for one in after} >= {"appearance"}
    for one in after:
        assert one.front_id == fronts[int(one.photo[1:]) - 1 + one.facade].front_id


def test_in_a_row_of_identical_houses_order_decides_and_says_so() -> None:
    fronts = ring((7.6,) * 8)
    filed, seen = street_of(fronts, (2, 3, 4, 5))
    claims = claimed(fronts, filed, seen, pairs_of(seen, lambda *_: 0.9))
    assert len(claims) >= 8
    for one in claims:
        assert one.front_id == fronts[int(one.photo[1:]) - 1 + one.facade].front_id
        assert one.told in ("own", "order")


def test_a_photograph_filed_under_another_lot_is_outvoted() -> None:
    fronts = ring()
    filed, seen = street_of(fronts, (2, 3, 4, 5))
    filed["p4"] = ["9-21-2"]  # across the block
    alike = pairs_of(seen, lambda a, b: 0.98 if shown_by(a) == shown_by(b) else 0.03)
    claims = claimed(fronts, filed, seen, alike)
    (moved,) = (one for one in claims if (one.photo, one.facade) == ("p4", 1))
    assert moved.front_id == "9-4-0"
    assert moved.told == "appearance"


def test_the_order_of_photographs_and_facades_changes_nothing() -> None:
    fronts = ring()
    filed, seen = street_of(fronts, (2, 3, 4))
    alike = pairs_of(seen, lambda a, b: 0.9 if shown_by(a) == shown_by(b) else 0.1)
    turned = dict(reversed(filed.items()))
    back = {(b, a): p for (a, b), p in reversed(alike.items())}
    there = claimed(fronts, filed, seen, alike)
    again = claimed(fronts[::-1], turned, seen[::-1], back)
    assert [replace(one, probability=0.0) for one in there] == [
        replace(one, probability=0.0) for one in again
    ]


def test_a_front_that_the_photograph_cuts_off_is_told_by_what_is_seen() -> None:
    fronts = ring()
    *own, last = photographed(fronts, (2, 3, 4), 3)
    sliver = replace(last, right=last.left + 0.15 * last.width, cut=True)
    claims = claimed(fronts, {"p": ["9-3-0"]}, [*own, sliver])
    assert lots(claims) == {0: "9-2-0", 1: "9-3-0", 2: "9-4-0"}
    whole = replace(sliver, cut=False)
    doubted = claimed(fronts, {"p": ["9-3-0"]}, [*own, whole])
    (cut,), before = ([c for c in made if c.facade == 2] for made in (claims, doubted))
    assert not before or before[0].probability < cut.probability


def test_a_target_that_order_and_widths_contradict_is_not_claimed() -> None:
    """The board's arrow hit the neighbour to the left of the lot that is meant."""
    fronts = ring((20.0, 8.0, 14.4, 8.0, 9.0, 7.0, 12.0, 20.0))
    left, meant, right = photographed(fronts, (0, 1, 2), 1)
    seen = [
        replace(left, target_score=0.97),
        replace(meant, target_score=0.07),
        replace(right, right=right.left + 0.3 * right.width, cut=True),
    ]
    claims = lots(claimed(fronts, {"p": ["9-1-0"]}, seen))
    assert claims.get(0) != "9-1-0"
    assert {n: lot for n, lot in claims.items() if lot != fronts[n].front_id} == {}


def test_a_facade_at_the_edge_of_its_photo_is_cut_off() -> None:
    stood = Standpoint(
        size_px=(600, 800),
        photo_from_camera=np.eye(3),
        focal_sd=0.1,
        position=(0.5, 0.2, 2.0),
        position_sd=0.1,
        front_from_camera=np.eye(3),
        quad_px=np.array([[100.0, 100], [400, 100], [400, 700], [100, 700]]),
        roof=1.4,
    )
    one = listed.seen()
    assert not stretch(one, stood).cut
    for shift in (-95, 190):
        assert stretch(
            one, replace(stood, quad_px=stood.quad_px + np.array([shift, 0]))
        ).cut
