"""Photographs that other photographs know better: what they show is not their lot."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import Final

from nostalgin_core.block.corner import building
from nostalgin_core.records import Assignment, Front, Rejection, Seen
from nostalgin_core.views import Claim

REASON: Final = "another lot by its looks"
SURE: Final = 0.9  # less doesn't take a facade from the lot that it is filed under


def outvoted(
    outcomes: Sequence[Assignment | Rejection],
    claims: Iterable[Claim],
    fronts: Sequence[Front],
    candidates: Mapping[str, Sequence[str]],
    seen: Iterable[Seen],
) -> tuple[Assignment | Rejection, ...]:
    """Take back facades that surely look like another lot elsewhere, and say so.

    A photograph is filed under the wrong lot, or the network took a neighbour for its
    target, beside its own lot or instead of it: its lot can't wear that facade.
    """
    buildings = {front.front_id: building(front) for front in fronts}
    targets = {(one.photo, one.facade) for one in seen if one.target}
    others = {
        (one.photo, one.facade): one
        for one in claims
        if one.told == "appearance"
        and one.probability >= SURE
        and (one.photo, one.facade) in targets
        and named(one) not in lots(candidates.get(one.photo, ()), buildings)
    }
    beside = {
        one.photo: one.facade
        for one in outcomes
        if isinstance(one, Assignment) and (one.photo, one.facade) not in others
    }
    kept: list[Assignment | Rejection] = []
    for one in outcomes:
        claim = (
            others.get((one.photo, one.facade)) if isinstance(one, Assignment) else None
        )
        kept.append(one if claim is None else told(claim, beside.get(claim.photo)))
    return tuple(kept)


def named(claim: Claim) -> str:
    """Name the building of a claim, listed or not."""
    return claim.front_id.rpartition("-")[0]


def lots(names: Collection[str], buildings: Mapping[str, str]) -> set[str]:
    """Name the buildings that a photograph is filed under."""
    return {buildings[name] for name in names if name in buildings}


def told(claim: Claim, beside: int | None) -> Rejection:
    """Name the likeliest lot of a facade that was outvoted, and what is to be done.

    `beside` is a facade of the same photograph that stays with its own lot.
    """
    remedy = (
        "correct the photograph's lot, or its target"
        if beside is None
        else f"facade {beside} stays its own lot's; correct its target if that is wrong"
    )
    detail = (
        f"facade {claim.facade} is lot {named(claim)} in its neighbours' photographs "
        f"({claim.probability:.0%} sure): {remedy}"
    )
    return Rejection(claim.photo, "assign", REASON, detail)
