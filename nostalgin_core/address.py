"""House numbers and streets, as catalogues write them."""

import re

STREET_M = 18.3  # 60 feet from front to front: a side street of 1811
AVENUE_M = 30.5  # 100 feet
WIDE = frozenset({"avenue", "ave", "broadway", "boulevard", "bowery", "square"})

NUMBER = r"(\d{1,9})(?!\d)"  # longer ones number no house
NUMBERS = re.compile(
    rf"\s*{NUMBER}\s*[A-Za-z]?(?:\s*(?:1/2|½))?(?:\s*[-/\u2013]\s*{NUMBER})?"
)


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


def plain_name(street: str) -> str:
    """Write a street's name in one way."""
    return " ".join(street.casefold().split())


def street_width(street: str) -> float:
    """Tell a street's width from front to front in metres, by its name alone."""
    words = {word.strip(".,") for word in street.casefold().split()}
    return AVENUE_M if WIDE & words else STREET_M
