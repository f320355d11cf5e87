"""What it costs to take each of many texts for each of many keys, all at once.

    d(i, j) = min(d(i-1, j-1) + taken, d(i-1, j) + added, d(i, j-1) + lost)

Here d is of the first i marks of a text and the first j that were wanted, as in
`misread.apart`, whose sums these are, in the same order. A cell is an array of all
pairs, for a board has hundreds of candidates on the list of a whole city.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from jaxtyping import Float, Int

from nostalgin_core.placard import misread
from nostalgin_core.placard.misread import HALF, LONGEST, Key

AT_ONCE: Final = 1 << 18  # pairs: some ten megabytes


def costs(texts: Sequence[str], keys: Sequence[Key]) -> Float[np.ndarray, "text key"]:
    """Sum up what must have gone wrong if `cleaned` texts are of keys, in nats.

    A reader may have missed one half of the board: the other tells nothing of it.
    """
    halves = [misread.halves(key) for key in keys]
    whole = apart(texts, ["-".join(both) for both in halves])
    block = each(texts, [block for block, _ in halves])
    lot = each(texts, [f"-{lot}" for _, lot in halves])
    return np.minimum(whole, HALF + np.minimum(block, lot))


def each(
    texts: Sequence[str], wanted: Sequence[str]
) -> Float[np.ndarray, "text wanted"]:
    """Do as `apart` where many of what is wanted are the same."""
    different, places = np.unique(np.array(wanted, str), return_inverse=True)
    return apart(texts, [*map(str, different)])[:, places]


def apart(
    texts: Sequence[str], wanted: Sequence[str]
) -> Float[np.ndarray, "text wanted"]:
    """Sum up what must have gone wrong if texts are of marks that were wanted.

    Of what is longer than `LONGEST` it is infinite.
    """
    found = np.full((len(texts), len(wanted)), np.inf)
    short = [i for i, one in enumerate(texts) if len(one) <= LONGEST]
    fitting = [i for i, one in enumerate(wanted) if len(one) <= LONGEST]
    if not short or not fitting:
        return found
    those = [wanted[i] for i in fitting]
    step = max(1, AT_ONCE // len(fitting))
    for first in range(0, len(short), step):
        some = short[first : first + step]
        found[np.ix_(some, fitting)] = _apart([texts[i] for i in some], those)
    return found


def _apart(
    texts: Sequence[str], wanted: Sequence[str]
) -> Float[np.ndarray, "text wanted"]:
    seen, read = _marks(texts)
    marks, places = _marks(wanted)
    taken = np.array([[misread.taken(one, mark) for mark in marks] for one in seen])
    added = np.array([misread.added(one) for one in seen])
    after = np.array([[misread.lost(a + b, 1, b) for b in marks] for a in marks])
    lost = [after[marks.index("\0"), places[:, 0]]]
    lost += [after[places[:, j - 1], places[:, j]] for j in range(1, places.shape[1])]
    ends = np.array([len(one) for one in wanted])[None, None]
    lengths = np.array([len(one) for one in texts])[:, None]
    before = np.zeros((len(lost) + 1, len(texts), len(wanted)))
    before[1:] = np.cumsum(lost, axis=0)[:, None]
    found = np.take_along_axis(before, ends, axis=0)[0]
    for i in range(int(lengths.max())):
        row = np.empty_like(before)
        more, same = added[read[:, i]][:, None], taken[read[:, i]]
        row[0] = before[0] + more
        for j in range(len(lost)):
            way = np.minimum(before[j] + same[:, places[:, j]], before[j + 1] + more)
            np.minimum(way, row[j] + lost[j], out=row[j + 1])
        ended = np.take_along_axis(row, ends, axis=0)[0]
        found, before = np.where(lengths == i + 1, ended, found), row
    return found


def _marks(words: Sequence[str]) -> tuple[list[str], Int[np.ndarray, "word place"]]:
    """List the marks of words, and where in that list each of each word stands.

    Shorter words end with NULs.
    """
    table = np.array([f"{word}\0" for word in words], f"U{max(map(len, words)) + 1}")
    points = table.view(np.uint32).reshape(len(words), -1)
    different, places = np.unique(points, return_inverse=True)
    return [chr(one) for one in different], places.reshape(points.shape)
