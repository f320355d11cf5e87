"""Patterns that others wrote are searched for in time linear in the text.

RE2 (Cox, 2010) has no pattern that runs away: what it can't search for in linear time,
as a reference back, it refuses. Patterns of our own need no such guard, and Python's
`re` finds them in a third of the time, of which a million names ask.
"""

import re
from collections.abc import Collection, Mapping
from functools import lru_cache
from typing import Final, Protocol, runtime_checkable

import re2

LONGEST: Final = 1000  # letters of a pattern
MOST_BYTES: Final = 1 << 20  # that a pattern and its search may take


@runtime_checkable
class Match(Protocol):
    """Where an expression was found."""

    def __getitem__(self, group: int, /) -> bytes | None:
        """Give what a group holds, if it took part."""
        ...


@runtime_checkable
class Expression(Protocol):
    """A pattern that is ready to search bytes."""

    @property
    def groupindex(self) -> Mapping[bytes, int]:
        """Number the groups that have names."""
        ...

    def search(self, text: bytes, /) -> Match | None:
        """Find it for the first time."""
        ...


@lru_cache(maxsize=64)
def compiled(pattern: str) -> Expression:
    """Make a pattern ready to search bytes.

    Raises:
        ValueError: if it is none; the words say why.
    """
    if len(pattern) > LONGEST:
        raise ValueError(f"longer than {LONGEST:,} letters")
    options = re2.Options()
    options.log_errors, options.max_mem = False, MOST_BYTES
    try:
        return re2.compile(pattern.encode(), options)
    except re2.error as problem:
        (why,) = problem.args
        raise ValueError(why.decode(errors="replace")) from problem


def groups(pattern: str) -> set[str]:
    """Name the groups of a pattern.

    Raises:
        ValueError: if it is none.
    """
    return {name.decode() for name in compiled(pattern).groupindex}


def found(pattern: str, text: str, wanted: Collection[str]) -> Mapping[str, str] | None:
    """Search for a pattern, and give what its wanted groups hold, or nothing.

    Letters that no text can have, as those of a file name in no encoding, are taken for
    question marks.

    Raises:
        ValueError: if it is no pattern, or lacks a group.
    """
    expression = compiled(pattern)
    match = expression.search(text.encode(errors="replace"))
    if match is None:
        return None
    place = {name.decode(): number for name, number in expression.groupindex.items()}
    lacking = sorted({*wanted} - {*place})
    if lacking:
        raise ValueError(f"no group {lacking[0]}")
    return {
        name: (match[place[name]] or b"").decode(errors="replace") for name in wanted
    }


def found_of_ours(
    pattern: str, text: str, wanted: Collection[str]
) -> Mapping[str, str] | None:
    """Search for a pattern that comes with the program, as `found` does for others."""
    match = ours(pattern).search(text)
    return None if match is None else {name: match[name] or "" for name in wanted}


@lru_cache(maxsize=64)
def ours(pattern: str) -> re.Pattern[str]:
    """Make a pattern of our own ready to search."""
    return re.compile(pattern)
