"""What boards say is joined with a list's keys, by several processes where it is much.

Each board is joined by itself, but with the keys of the whole list: a slip may be in
any figure of a block, so that the keys near a board lie all over the city. Each process
holds them once, and takes boards by the hundred.
"""

import multiprocessing
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import Final

from nostalgin_core import placard
from nostalgin_core.placard import Joined, Keys, Look

MUCH: Final = 2000  # boards: a process joins them in twice the time of its start
AT_ONCE: Final = 200  # boards

Looks = tuple[str, tuple[Look, ...]]  # of a photograph's board

_keys: Keys | None = None  # of a process that was started for this


def joined(
    boards: Mapping[str, Sequence[Look]], keys: Keys | None, *, processes: int = 1
) -> dict[str, Joined]:
    """Join each board, by at most so many processes; what comes of it is the same."""
    several = min(processes, len(boards) // MUCH)
    if several < 2:
        return {name: placard.joined(looks, keys) for name, looks in boards.items()}
    some = [(name, tuple(looks)) for name, looks in boards.items()]
    parts = [some[at : at + AT_ONCE] for at in range(0, len(some), AT_ONCE)]
    # We may have threads, which no fork has.
    afresh = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(several, afresh, _take, (keys,)) as pool:
        return dict(one for part in pool.map(_joined, parts) for one in part)


def _take(keys: Keys | None) -> None:
    global _keys  # noqa: PLW0603 - sent once to each process, not with each part
    _keys = keys


def _joined(some: Sequence[Looks]) -> list[tuple[str, Joined]]:
    return [(name, placard.joined(looks, _keys)) for name, looks in some]
