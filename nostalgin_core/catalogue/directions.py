"""Which way house numbers run round a block.

Each street has one law: +1 if its odd numbers rise anticlockwise round the blocks that
stand on it, -1 if they fall. Even numbers stand across the street, so they run the
other way. Along a side the numbers then rise if law x parity is +1.

Two kinds of witness vote. Lots run anticlockwise, so that numbers that rise with them
rise anticlockwise; the first few lots of a block are often an exception. And parallel
streets are numbered the same way, so that on opposite sides of a four-sided ring the
numbers run opposite ways round. The surest street is settled first, and then counts for
its opposites.
"""

import heapq
from collections.abc import Collection, Sequence

Law = dict[str, int]
SideFacts = tuple[str, int, float]  # street, parity (1 odd, -1 even), votes of its lots

OPPOSITE_VOTES = 3.0  # as three pairs of lots: one odd pair does not outweigh it


def directions(
    rings: Sequence[Sequence[SideFacts | None]],
    ruled: Collection[str] | None = None,
) -> tuple[Law, tuple[str, ...]]:
    """Settle the law of each street; return warnings where nothing spoke for either.

    Only streets that the law rules are warned of, if `ruled` names them.
    """
    votes: dict[str, float] = {}
    for ring in rings:
        for fact in ring:
            if fact is not None:
                street, parity, pairs = fact
                votes[street] = votes.get(street, 0.0) + parity * pairs
    law: Law = {}
    warnings = []
    across = _opposites(rings)
    waiting = [(-abs(vote), street) for street, vote in votes.items()]
    heapq.heapify(waiting)
    while waiting:
        vote, street = heapq.heappop(waiting)
        if street in law or vote != -abs(votes[street]):
            continue  # its vote has changed since, and waits with that
        law[street] = 1 if votes[street] >= 0 else -1
        if votes[street] == 0 and (ruled is None or street in ruled):
            warnings.append(
                f"{street}: nothing tells which way its numbers run; give its rows a "
                "side and an order if it is built backwards"
            )
        for other, parities in across.get(street, ()):
            votes[other] -= OPPOSITE_VOTES * law[street] * parities
            heapq.heappush(waiting, (-abs(votes[other]), other))
    return law, tuple(warnings)


def _opposites(
    rings: Sequence[Sequence[SideFacts | None]],
) -> dict[str, list[tuple[str, int]]]:
    """List for each street those across a block, with the product of both parities."""
    pairs: dict[str, list[tuple[str, int]]] = {}
    for ring in rings:
        for index, fact in enumerate(ring):
            across = ring[(index + 2) % 4] if len(ring) == 4 else None
            if fact is not None and across is not None:
                other = (across[0], fact[1] * across[1])
                pairs.setdefault(fact[0], []).append(other)
    return pairs
