"""What neighbours' photographs lend to fronts that their own do not show well."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import replace

from nostalgin_core.block import assign
from nostalgin_core.block.cuboid import LEAST_CLEAR
from nostalgin_core.records import Assignment, Front, Seen
from nostalgin_core.views import Claim

WORN = 0.8  # how probably a facade shows a front that wears it: a wrong one is seen


def lent(
    fronts: Sequence[Front],
    assignments: Iterable[Assignment],
    claims: Iterable[Claim],
    seen: Iterable[Seen],
) -> tuple[Assignment, ...]:
    """Give each front without a legible photograph the best of its neighbours'.

    A facade is worn by one front. It scores as its own photograph's would, by how
    probably it shows the front in place of how probably it is the target.
    """
    given = tuple(assignments)
    facades = {(one.photo, one.facade): one for one in seen}
    worn = {(one.photo, one.facade) for one in given}
    dressed = {
        one.front_id
        for one in given
        if facades[one.photo, one.facade].clear >= LEAST_CLEAR
    }
    bare = {one.front_id for one in fronts} - dressed
    offers: dict[str, list[Assignment]] = defaultdict(list)
    for claim in claims:
        texture = claim.photo, claim.facade
        sure = claim.probability >= WORN
        if sure and claim.front_id in bare and texture in facades.keys() - worn:
            one = replace(facades[texture], target_score=claim.probability)
            if not assign.fault(one) and one.clear >= LEAST_CLEAR:
                score = assign.score(one)
                offers[claim.front_id].append(
                    Assignment(
                        claim.front_id, *texture, score, lent=claim.told != "own"
                    )
                )
    return tuple(
        max(offers[name], key=lambda one: (one.score, one.photo, -one.facade))
        for name in sorted(offers)
    )
