"""Which elevations show a front, and how wide a front is that no list measures."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from nostalgin_core.block.cuboid import ASSUMED_M
from nostalgin_core.block.heights import Shown
from nostalgin_core.records import Assignment, Front, Texture

WIDTH_SD, HEIGHT_SD = 0.4, 0.6  # of the logarithms: heights vary more than widths

Aspects = Mapping[Texture, Mapping[str, Any]]  # aspect, its spread, and storeys


def elevations(
    assignments: Sequence[Assignment], aspects: Aspects
) -> dict[str, list[Shown]]:
    """List what shows each front."""
    shown: dict[str, list[Shown]] = {}
    for one in assignments:
        texture = (one.photo, one.facade)
        shown.setdefault(one.front_id, []).append(
            Shown(texture, score=one.score, lent=one.lent, **aspects[texture])
        )
    return shown


def with_seen_widths(
    fronts: Sequence[Front], shown: Mapping[str, Sequence[Shown]]
) -> list[Front]:
    """Mend assumed widths by the proportions of what a photograph shows.

    Both fronts of a building are equally high, so that w2 = w1 a2 / a1 where one width
    is known: two facades specify the cuboid. Else width and height are both guesses:
    with w0 the assumed width, h0 a common height and s their spreads (as logarithms),
    the likeliest width is the weighted mean of ln w0 and ln(h0 a).
    """
    best = {
        front_id: max(some, key=lambda one: (one.score, one.texture))
        for front_id, some in shown.items()
    }
    known = {
        (front.block, front.lot): front
        for front in fronts
        if not front.width_assumed and front.front_id in best
    }
    trust = WIDTH_SD**2 / (WIDTH_SD**2 + HEIGHT_SD**2)  # in the height

    def widened(front: Front) -> Front:
        if not front.width_assumed or front.front_id not in best:
            return front
        aspect = best[front.front_id].aspect
        other = known.get((front.block, front.lot))
        if other is not None:
            width_m = other.width_m * aspect / best[other.front_id].aspect
        else:
            width_m = front.width_m ** (1 - trust) * (ASSUMED_M * aspect) ** trust
        return replace(front, width_m=width_m)

    return [widened(front) for front in fronts]
