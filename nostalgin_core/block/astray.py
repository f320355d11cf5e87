"""Photographs that other photographs know better: what they show is not their lot."""

from collections.abc import Collection, Iterable, Mapping, Sequence

from nostalgin_core.block.corner import building
from nostalgin_core.records import Assignment, Front, Rejection, Seen
from nostalgin_core.views import Claim

REASON = "another lot by its looks"


def outvoted(
    outcomes: Iterable[Assignment | Rejection],
    claims: Iterable[Claim],
    fronts: Sequence[Front],
    candidates: Mapping[str, Sequence[str]],
    seen: Iterable[Seen],
) -> tuple[Assignment | Rejection, ...]:
    """Take back facades that look like another lot in others' photographs, and say so.

    A photograph is filed under the wrong lot, or the network took a neighbour for its
    target: either way its own lot can't wear that facade.
    """
    buildings = {front.front_id: building(front) for front in fronts}
    targets = {(one.photo, one.facade) for one in seen if one.target}
    others = {
        (one.photo, one.facade): one
        for one in claims
        if one.told == "appearance"
        and (one.photo, one.facade) in targets
        and named(one) not in lots(candidates.get(one.photo, ()), buildings)
    }
    kept: list[Assignment | Rejection] = []
    for one in outcomes:
        claim = (
            others.get((one.photo, one.facade)) if isinstance(one, Assignment) else None
        )
        kept.append(one if claim is None else told(claim))
    return tuple(kept)


def named(claim: Claim) -> str:
    """Name the building of a claim, listed or not."""
    return claim.front_id.rpartition("-")[0]


def lots(names: Collection[str], buildings: Mapping[str, str]) -> set[str]:
    """Name the buildings that a photograph is filed under."""
    return {buildings[name] for name in names if name in buildings}


def told(claim: Claim) -> Rejection:
    """Name the likeliest lot of a photograph that was outvoted."""
    detail = (
        f"facade {claim.facade} is lot {named(claim)} in its neighbours' photographs "
        f"({claim.probability:.0%} sure): correct the photograph's lot, or its target"
    )
    return Rejection(claim.photo, "assign", REASON, detail)
