"""What several looks at a board say is joined with the keys that an archive's list has.

A look is what a reader of print made of one rendering of the board. Each key's cost is
the mean over the looks of what must have gone wrong in them (`misread`), times the
number of looks that looks as like each other are worth. Keys, the board of a lot that
the list does not have, and mere noise then share a probability of 1 (Bayes, equal
priors for all keys of the list):

    p(key) = exp(-cost(key)) / sum of exp(-cost) over all of them

The key is joined if p is high and its own cost is low: of a board that can't be read,
the nearest key is still far. Without a list every number of figures is a key.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Float

from nostalgin_core.placard import misread, pairs
from nostalgin_core.placard.misread import Key
from nostalgin_core.placard.placard import parse

SURE: Final = 0.95  # from which a key is joined
WORTH: Final = 2.0  # independent looks, that many alike ones are worth
NOISE: Final = 9.0  # nats: a look that is worse explained says nothing
STRANGER: Final = 4.6  # nats: of a hundred boards one is of a lot off the list
MOST: Final = 3.5  # nats that may have gone wrong in the best look of a whole board
FEWEST: Final = 2  # figures of a text that may be of a board
MOST_PIECES: Final = 12  # of a line
TRIED_AGAIN: Final = 6  # figures: of longer rows no two slips are tried


Line = tuple[str, ...]  # the pieces of print on one line, from left to right


class Look(NamedTuple):
    """What a reader made of one rendering of a board."""

    lines: tuple[Line, ...]


class Run(NamedTuple):
    """Pieces of a line that may be a board's number."""

    text: str
    left_out: float  # nats: what stands beside them on their line


@dataclass(frozen=True)
class Joined:
    """The key that a board most probably shows, and the second best."""

    key: Key | None  # None: nothing is near
    score: float = 0.0  # probability
    runner_up: Key | None = None
    runner_up_score: float = 0.0
    literal: Key | None = None  # what the looks spell, whether it is on the list or not
    text: str = ""  # the most telling line
    cost: float = math.inf  # nats, in the best look of a whole board
    listed: bool = True  # the key is on the list, or there is none

    @property
    def sure(self) -> bool:
        """Tell whether the key may be believed."""
        near = self.score >= SURE and self.cost <= MOST
        return self.key is not None and self.listed and near


@dataclass(frozen=True)
class Keys:
    """The keys of a list, found by their figures."""

    every: frozenset[Key]

    @cached_property
    def by_figures(self) -> Mapping[str, tuple[Key, ...]]:
        """Find keys by block and lot without the dash between."""
        found: dict[str, list[Key]] = defaultdict(list)
        for key in sorted(self.every):
            found[misread.figures("-".join(key))].append(key)
        return {figures: tuple(keys) for figures, keys in found.items()}

    def near(self, texts: Iterable[str]) -> set[Key]:
        """List the keys that a slip or two make of texts."""
        rows = {misread.figures(text) for text in texts}
        found = self._of(row for one in rows for row in (one, *misread.slips(one)))
        short = [one for one in rows if 2 <= len(one) <= TRIED_AGAIN]
        if not found and short:
            twice = {s for one in short for s in misread.slips(one)}
            found = self._of(row for one in twice for row in misread.slips(one))
        return found

    def _of(self, rows: Iterable[str]) -> set[Key]:
        return {key for row in rows for key in self.by_figures.get(row, ())}


def known(keys: Collection[Key]) -> Keys:
    """Take the keys of a list."""
    return Keys(frozenset(keys))


def joined(looks: Sequence[Look], keys: Keys | None) -> Joined:
    """Find the key that looks at a board most probably show.

    Without `keys` every block and lot may be meant.
    """
    telling = [runs for look in looks if (runs := runs_of(look))]
    if not telling:
        return Joined(None)
    literals = spelled(telling)
    if keys is None:
        candidates = {one for literal in literals for one in around(literal)}
    else:
        every = sorted({run.text for runs in telling for run in runs})
        candidates = keys.near(every) | set(literals)
    if not candidates:
        return Joined(None, text=telling[0][0].text)
    ordered = sorted(candidates)
    return judged(ordered, in_looks(telling, ordered), keys, literals, telling)


def runs_of(look: Look) -> list[Run]:
    """List the runs of pieces in a look that may be a board's number."""
    runs = []
    for line in look.lines:
        pieces = [one for one in map(misread.cleaned, line) if one][:MOST_PIECES]
        ends = range(1, len(pieces) + 1)
        for first, end in ((i, j) for j in ends for i in range(j)):
            left_out = [*pieces[:first], *pieces[end:]]
            text = " ".join(pieces[first:end])
            runs.append(Run(text, sum(map(misread.left, left_out))))
    return [run for run in runs if number(run.text)]


def judged(
    candidates: Sequence[Key],
    table: Float[np.ndarray, "key look"],
    keys: Keys | None,
    literals: Mapping[Key, int],
    telling: Sequence[Sequence[Run]],
) -> Joined:
    """Share a probability of 1 among the candidates, and take the best."""
    entire = int((table.min(axis=0) < misread.HALF).sum())
    weight = min(1.0, WORTH / max(entire, 1))
    strange = [keys is not None and key not in keys.every for key in candidates]
    nats = weight * table.sum(axis=1) + STRANGER * np.array(strange)
    noise = weight * NOISE * len(telling)
    least = min(noise, float(nats.min()))
    shares = np.exp(least - nats)
    shares = shares / (shares.sum() + math.exp(least - noise))
    order = np.argsort(-shares, kind="stable")[:2]
    best, *others = (candidates[one] for one in order)
    scores = [float(shares[one]) for one in order]
    literal = max(sorted(literals), key=lambda one: literals[one], default=None)
    runs = [run for runs in telling for run in runs]
    text = min(runs, key=lambda one: (misread.whole(one.text, best), one.text)).text
    return Joined(
        key=best,
        score=scores[0],
        runner_up=others[0] if others else None,
        runner_up_score=scores[1] if others else 0.0,
        literal=literal,
        text=text,
        cost=misread.whole(text, best),
        listed=not strange[order[0]],
    )


def in_looks(
    telling: Sequence[Sequence[Run]], candidates: Sequence[Key]
) -> Float[np.ndarray, "key look"]:
    """Sum up what must have gone wrong in each look, in the best of its runs."""
    texts = sorted({run.text for runs in telling for run in runs})
    costs = dict(zip(texts, pairs.costs(texts, candidates), strict=True))
    best = [
        np.min([run.left_out + costs[run.text] for run in runs], axis=0)
        for runs in telling
    ]
    return np.minimum(NOISE, np.transpose(best))


def number(text: str) -> bool:
    """Tell whether a text may be of a board: it has two figures, or what looks so."""
    printed = any(one.isdigit() for one in text) and len(text) <= misread.LONGEST
    return printed and len(misread.figures(text)) >= FEWEST


def spelled(telling: Sequence[Sequence[Run]]) -> Counter[Key]:
    """Count the looks that spell a whole key, by key."""
    found: Counter[Key] = Counter()
    for runs in telling:
        parsed = (parse([run.text]) for run in runs)
        found.update({(one.block, one.lot) for one in parsed if one is not None})
    return found


def around(key: Key) -> set[Key]:
    """List a key and all that differ from it by one figure."""
    block, lot = key
    blocks = {(one, lot) for one in misread.slips(block)}
    lots = {(block, one) for one in misread.slips(lot)}
    return {key, *(one for one in blocks | lots if sound(one))}


def sound(key: Key) -> bool:
    """Tell whether figures may be a block and a lot."""
    return all(one and not one.startswith("0") and len(one) <= 5 for one in key)
