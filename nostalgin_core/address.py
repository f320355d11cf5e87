"""House numbers and streets, as catalogues write them."""

import re
from collections.abc import Mapping
from functools import lru_cache
from typing import Final

STREET_M = 18.3  # 60 feet from front to front: a side street of 1811
AVENUE_M = 30.5  # 100 feet
WIDE = frozenset({"avenue", "ave", "broadway", "boulevard", "bowery", "square"})

NUMBER = r"(\d{1,9})(?!\d)"  # longer ones number no house
NUMBERS = re.compile(
    rf"\s*{NUMBER}\s*[A-Za-z]?(?:\s*(?:1/2|½))?(?:\s*[-/\u2013]\s*{NUMBER})?"
)

KINDS: Final[Mapping[str, str]] = {
    **dict.fromkeys(("st", "str", "strasse", "street"), "street"),
    **dict.fromkeys(("av", "ave", "avenue"), "avenue"),
    **dict.fromkeys(("blvd", "boul"), "boulevard"),
    "pl": "place",
    "sq": "square",
    "rd": "road",
    "ln": "lane",
    "dr": "drive",
    "ct": "court",
    "ter": "terrace",
    "pkwy": "parkway",
}
KINDED: Final = frozenset(KINDS.values())
POINTS: Final = {"n": "north", "e": "east", "s": "south", "w": "west"} | {
    word: word for word in ("north", "east", "south", "west")
}
NUMBERED: Final = (
    *("first", "second", "third", "fourth", "fifth", "sixth"),
    *("seventh", "eighth", "ninth", "tenth", "eleventh", "twelfth"),
)
ORDINALS: Final = {word: str(number) for number, word in enumerate(NUMBERED, 1)}


def house_numbers(address: str) -> tuple[int, int] | None:
    """Read the lowest and the highest house number of an address.

    "561-565" is (561, 565); "108-12" is short for 108-112; "147" and "147A" stand
    alone. None where an address starts with no number.
    """
    found = NUMBERS.match(address)
    if found is None:
        return None
    low, rest = found.groups()
    if rest is None:
        return int(low), int(low)
    if len(rest) < len(low):
        rest = low[: len(low) - len(rest)] + rest
    return min(int(low), int(rest)), max(int(low), int(rest))


@lru_cache(maxsize=4096)
def plain_name(street: str) -> str:
    """Write a street's name in one way, however people shorten it.

    "E. 34 St.", "EAST 34TH STREET" and "East 34th St" are one, and so are "5th Ave" and
    "Fifth Avenue", "Hauptstr." and "Hauptstra\u00dfe". What kind of street it is stands
    last, or before its compass point; a "St." that stands first is a saint.
    """
    words = re.sub(r"[.,\s]+", " ", street.casefold()).split()
    if len(words) > 1:
        words = [ORDINALS.get(word, word) for word in words]
        words = [re.sub(r"^(\d+)(?:st|nd|rd|th)$", r"\1", word) for word in words]
        kind = _kind(words)
        words[kind] = KINDS.get(words[kind], words[kind])
        lettered = len(words) == 2 and not KINDED.isdisjoint(words)  # S Street, Ave. S
        for end in (0, -1) if not lettered else ():
            words[end] = POINTS.get(words[end], words[end])
    return re.sub(r"(?<=\w)str$", "strasse", " ".join(words))


def _kind(words: list[str]) -> int:
    """Tell which word of a name says what kind of street it is."""
    if len(words) == 2 and len(words[1]) == 1:
        return 0  # Avenue A
    return len(words) - (2 if len(words) > 2 and words[-1] in POINTS else 1)


def street_width(street: str) -> float:
    """Tell a street's width from front to front in metres, by its name alone."""
    words = {word.strip(".,") for word in street.casefold().split()}
    return AVENUE_M if WIDE & words else STREET_M
