"""What the names of an archive's photographs tell of their lots, by its own patterns.

A pattern has the groups `block` and `lot`. It is sought in a name without folder and
suffix; where there is no list to be contradicted, laxer ones are, in small letters.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from nostalgin_core.catalogue.entry import stem
from nostalgin_core.expression import found, found_of_ours

Key = tuple[str, str]  # block and lot
WANTED: Final = ("block", "lot")
LONGEST: Final = 64  # letters of both


@dataclass(frozen=True)
class Naming:
    """Patterns of names, tried in their order."""

    patterns: tuple[str, ...] = ()
    without_list: tuple[str, ...] = ()  # tried after these, where there is no list
    shipped: bool = False  # these come with the program, and may be believed

    def told(self, name: str) -> Key | None:
        """Read block and lot from a file name that tells them surely."""
        if not self.patterns:
            return None
        plain = stem(name.replace("\\", "/")).strip()
        return self._first(self.patterns, plain)

    def guessed(self, name: str) -> Key | None:
        """Read block and lot from a file name that nothing else contradicts."""
        plain = stem(name).strip().casefold()
        return self.told(name) or self._first(self.without_list, plain)

    def _first(self, patterns: Sequence[str], name: str) -> Key | None:
        """Read block and lot by the first pattern that tells both."""
        search = found_of_ours if self.shipped else found
        for pattern in patterns:
            told = search(pattern, name, WANTED)
            if told is None:
                continue
            block, lot = number(told["block"]), number(told["lot"])
            if block and lot and len(block + lot) <= LONGEST:
                return block, lot
        return None


NAMELESS: Final = Naming()


def number(digits: str) -> str:
    """Write a number without leading zeros; what is none stays, if it is harmless."""
    if any(mark in digits for mark in "/\\\0"):
        return ""
    plain = digits.isdecimal() and len(digits) <= LONGEST
    return str(int(digits)) if plain else digits.strip()
