"""Boards joined with the list of a whole city: milliseconds a photograph.

    python tests/bench/bench_joined.py [PHOTOGRAPHS]

The list has 720,000 keys, 60 lots in each of 12,000 blocks: all of a board's neighbours
are there, so that hundreds of keys are weighed. Six looks at each board slip at random.
The baseline weighs each text and key by itself.
"""

import sys
import time
from collections.abc import Callable, Sequence

import numpy as np

from nostalgin_core import placard
from nostalgin_core.placard import Key, Look, misread, pairs

BLOCKS, LOTS = 12_000, 60
LOOKS = 6
SLIPS = 0.35  # of the looks
BESIDE = ("", "TRADE MARK", "1436", "FOR RENT")


def slipped(text: str, rng: np.random.Generator) -> str:
    """Change, lose or add one mark of some texts."""
    if rng.random() > SLIPS:
        return text
    place, mark = int(rng.integers(len(text))), str(rng.choice([*"0123456789OIBS -"]))
    return (
        text[:place]
        + ["", mark, mark + text[place]][rng.integers(3)]
        + text[place + 1 :]
    )


def look(key: Key, rng: np.random.Generator) -> Look:
    """Look at a board once."""
    text = slipped(f"{key[0]} -{key[1]} M", rng)
    beside = str(rng.choice(BESIDE))
    return Look((tuple(text.split()), (beside,)))


def one_by_one(texts: Sequence[str], keys: Sequence[Key]) -> np.ndarray:
    """Weigh each text and key by itself, as `pairs.costs` does all at once."""

    def cost(text: str, key: Key) -> float:
        block, lot = misread.halves(key)
        half = min(misread.apart(text, block), misread.apart(text, f"-{lot}"))
        return min(misread.whole(text, key), misread.HALF + half)

    return np.array([[cost(text, key) for key in keys] for text in texts])


def main(photographs: int) -> None:
    """Print what both ways take, and whether they say the same."""
    rng = np.random.default_rng(5)
    keys = placard.known(
        {(str(b + 1), str(n + 1)) for b in range(BLOCKS) for n in range(LOTS)}
    )
    shown = [
        (str(rng.integers(1, BLOCKS)), str(rng.integers(1, LOTS)))
        for _ in range(photographs)
    ]
    boards = [tuple(look(key, rng) for _ in range(LOOKS)) for key in shown]
    placard.joined(boards[0], keys)  # the list's keys are sorted once
    ways: dict[str, Callable] = {"baseline": one_by_one, "all at once": pairs.costs}
    told, took = [], []
    for name, way in ways.items():
        pairs.costs = way
        began = time.process_time()
        told.append([placard.joined(one, keys) for one in boards])
        took.append((time.process_time() - began) / photographs)
        print(f"{name:12} {1000 * took[-1]:8.2f} CPU ms a photograph", flush=True)
    same = "the same" if told[0] == told[1] else "NOT THE SAME"
    right = sum(
        one.sure and one.key == key for one, key in zip(told[1], shown, strict=True)
    )
    print(f"x{took[0] / took[1]:.1f}, {same}; {right} of {photographs} sure and right")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
