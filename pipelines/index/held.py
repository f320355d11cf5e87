"""A table's rows, held as lists of words and seen as mappings, one at a time.

As mappings a million rows take gigabytes; words that many of them share are held once.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Final, overload

Cells = dict[Any, Any]  # by column; what stands beyond the last one, under None
MOST_WORDS: Final = 1 << 16  # that are remembered, to be shared


class Held(Sequence[Cells]):
    """Rows below the names of their columns, none of which can be changed."""

    def __init__(self, names: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Take rows as they were read."""
        self._names, self._rows = names, rows

    def __len__(self) -> int:
        """Count the rows."""
        return len(self._rows)

    def __iter__(self) -> Iterator[Cells]:
        """Make each row's mapping anew."""
        return (by_column(self._names, row) for row in self._rows)

    @overload
    def __getitem__(self, place: int) -> Cells: ...

    @overload
    def __getitem__(self, place: slice) -> "Held": ...

    def __getitem__(self, place: int | slice) -> "Cells | Held":
        """Make the mapping of one row, or take some rows."""
        if isinstance(place, slice):
            return Held(self._names, self._rows[place])
        return by_column(self._names, self._rows[place])


def by_column(names: Sequence[str], row: Sequence[str]) -> Cells:
    """Put a row's cells under their columns' names, and what is too much under None."""
    cells: Cells = dict(zip(names, row, strict=False))
    return cells | ({None: row[len(names) :]} if len(row) > len(names) else {})


def shared(rows: Iterable[Sequence[str]]) -> Iterator[list[str]]:
    """Let cells that say the same be one word, as far as words are remembered."""
    words: dict[str, str] = {}
    for row in rows:
        if len(words) > MOST_WORDS:
            words.clear()
        yield [words.setdefault(cell, cell) for cell in row]
