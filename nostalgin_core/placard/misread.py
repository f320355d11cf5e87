"""How a reader of print errs: what it costs to take a text for a key.

    key    9 9 7 - 1 7 M
    text   9 9 7 -   7 M      2.5: a one beside the dash runs into it

Costs are negative logarithms of how often a reader does so, in nats: an edit distance
(Needleman and Wunsch, 1970) whose weights know which figures look alike. Spaces cost
next to nothing, letters that look like a figure little, a figure for quite another
one much.
"""

import re
from collections.abc import Iterable
from functools import lru_cache
from typing import Final

Key = tuple[str, str]  # block and lot

BOROUGHS: Final = "MXBKQR"  # Manhattan, Bronx (X, B), Brooklyn (K, B), Queens, Richmond
LETTER: Final = "@"  # of the borough, at a key's end
ALIKE: Final = 4.5  # one figure for another that looks like it: one in ninety
UNLIKE: Final = 7.0  # for any other
PAIRS: Final = frozenset(
    frozenset(pair)
    for pair in "38 35 36 08 06 09 17 14 56 58 68 89 27 49 39 79 69 98".split()  # noqa: SIM905
)
LOOKS_LIKE: Final = {  # a letter: the figures that it may be, the likelier first
    **dict.fromkeys("OQDU", "0"),
    **dict.fromkeys("IL|!JT", "17"),
    "S": "58",
    "B": "83",
    "Z": "2",
    "G": "69",
    "A": "4",
    "E": "3",
    "P": "9",
}
LETTER_FOR_FIGURE: Final = 1.0
LOST: Final = 5.0  # a figure that was not read
LOST_ONE: Final = 2.5  # a one beside the dash, which runs into it
ADDED: Final = 7.0  # a figure that is not there
ADDED_ONE: Final = 4.0  # a dash that was read as a one
HALF: Final = 2.5  # the block alone was read, or the lot alone
JUNK: Final = 2.0  # a letter that is not there: the arrow, a rim
LEFT_FIGURES: Final = 5.0  # a piece on the board's line that is none of it
LEFT_WORD: Final = 0.5
SPACE: Final = 0.05
DASH_A_SPACE: Final = 0.3
DASH_LOST: Final = 3.0  # and no space in its place
DASH_ADDED: Final = 2.0
LETTER_LOST: Final = 0.5
LETTER_WRONG: Final = 1.5
LONGEST: Final = 24  # letters of a text that may be a board's

_DASHES: Final = re.compile(r"[-_~\u2010-\u2015\u2212\uff0d\u4e00=]+")


def cleaned(text: str) -> str:
    """Write a text in capitals, figures, single spaces and dashes; drop other marks."""
    text = _DASHES.sub("-", text.upper())
    return " ".join(re.sub(r"[^A-Z0-9|!-]+", " ", text).split())


def spelt(key: Key) -> str:
    """Spell a key as a board does."""
    return "-".join(halves(key))


def halves(key: Key) -> tuple[str, str]:
    """Spell a key's block and lot, either of which may have a dash in it."""
    block, lot = key
    return block.upper(), f"{lot.upper()}{LETTER}"


def whole(text: str, key: Key) -> float:
    """Sum up what must have gone wrong if a text is of a whole key, in nats."""
    return apart(text, spelt(key))


@lru_cache(maxsize=65536)
def apart(text: str, wanted: str) -> float:
    """Sum up what must have gone wrong if a text is of marks that were wanted."""
    if len(text) > LONGEST or len(wanted) > LONGEST:
        return float("inf")
    before = [0.0]
    for place, mark in enumerate(wanted):
        before.append(before[-1] + lost(wanted, place, mark))
    for seen in text:
        row = [before[0] + added(seen)]
        for place, mark in enumerate(wanted):
            row.append(
                min(
                    before[place] + taken(seen, mark),
                    before[place + 1] + added(seen),
                    row[place] + lost(wanted, place, mark),
                )
            )
        before = row
    return before[-1]


def taken(seen: str, mark: str) -> float:
    """Tell what it costs that a mark of a key was read as what was seen."""
    if mark == LETTER:
        wrong = LETTER_WRONG if seen.isalpha() else UNLIKE
        return 0.0 if seen in BOROUGHS else wrong
    if seen == mark:
        return 0.0
    if mark == "-":
        return {" ": DASH_A_SPACE, "1": ADDED_ONE}.get(seen, ADDED)
    if seen in LOOKS_LIKE and mark in LOOKS_LIKE[seen]:
        return LETTER_FOR_FIGURE * (1 + LOOKS_LIKE[seen].index(mark))
    alike = frozenset((seen, mark)) in PAIRS
    return ALIKE if alike else UNLIKE


def lost(wanted: str, place: int, mark: str) -> float:
    """Tell what it costs that a mark of a key was not read."""
    if mark == LETTER:
        return LETTER_LOST
    if mark == "-":
        return DASH_LOST
    beside = mark == "1" and "-" in wanted[max(0, place - 1) : place]
    return LOST_ONE if beside else LOST


def added(seen: str) -> float:
    """Tell what it costs that something was read that no key has."""
    if seen == " ":
        return SPACE
    if seen == "-":
        return DASH_ADDED
    return ADDED if seen.isdigit() else JUNK


def left(text: str) -> float:
    """Tell what it costs that a piece beside a board's number is none of it."""
    return LEFT_FIGURES if any(map(str.isdigit, text)) else LEFT_WORD


def figures(text: str) -> str:
    """Write the figures of a text alone; letters that look like one count as one.

    The letter of a borough at the end is none of them.
    """
    bare = text.replace(" ", "").replace("-", "")
    bare = bare[:-1] if bare[-1:] in BOROUGHS else bare
    marks = (one if one.isdigit() else LOOKS_LIKE.get(one, "")[:1] for one in bare)
    return "".join(marks)


def slips(figures: str) -> Iterable[str]:
    """List what differs from a row of figures in one: changed, lost or added."""
    for place in range(len(figures) + 1):
        head, tail = figures[:place], figures[place:]
        for one in "0123456789":
            yield f"{head}{one}{tail}"
            if tail:
                yield f"{head}{one}{tail[1:]}"
        if tail:
            yield head + tail[1:]
