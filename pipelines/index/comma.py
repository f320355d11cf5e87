"""Comma-separated values as people and spreadsheets write them, read or refused.

A mark at the start, any line ends, quoted line breaks and empty lines are all read. An
empty line is a row without cells, so that rows keep the numbers that a spreadsheet
shows.
"""

import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any, Final

OTHERS: Final = re.compile(r"[;\t|]")  # what parts cells in other dialects

Cells = dict[Any, Any]  # by column; what stands beyond the last one, under None


class NoTable(ValueError):  # noqa: N818 - it reads as what it is about
    """Bytes that are no table, with the remedy."""


def parsed(data: bytes) -> tuple[list[str], list[Cells]]:
    """Read the names of the columns, and the rows below them.

    Raises:
        NoTable: if it is no UTF-8, has a broken quote, parts its cells by other signs,
            or names two columns alike.
    """
    try:
        text = io.StringIO(data.decode("utf-8-sig"), newline="")
        reader = csv.reader(text, strict=True)
        names = next(reader, [])
        rows = [by_column(names, row) for row in reader]
    except UnicodeDecodeError as problem:
        raise NoTable(f"is no UTF-8 ({problem}): save it as CSV in UTF-8") from problem
    except csv.Error as problem:
        raise NoTable(f"is no CSV ({problem}): save it anew as CSV") from problem
    if len(names) == 1 and (mark := OTHERS.search(names[0])):
        raise NoTable(f"parts its cells by {mark[0]!r}: save it with commas")
    twice = [name for name, count in Counter(names).items() if name and count > 1]
    if twice:
        raise NoTable(f"has two columns {twice[0]!r}: rename or delete one of them")
    return names, rows


def by_column(names: Sequence[str], row: Sequence[str]) -> Cells:
    """Put a row's cells under their columns' names, and what is too much under None."""
    cells: Cells = dict(zip(names, row, strict=False))
    return cells | ({None: row[len(names) :]} if len(row) > len(names) else {})


def blank(cells: Cells) -> bool:
    """Tell whether nothing is written in a row."""
    beyond = cells.get(None) or ()
    every = [*(cell for name, cell in cells.items() if name is not None), *beyond]
    return not any(str(cell).strip() for cell in every if cell is not None)


def written(names: Sequence[str], rows: Iterable[Cells]) -> str:
    """Write a table that `parsed` reads back, whatever line breaks its cells hold."""
    return line(names) + "".join(line([row.get(n) for n in names]) for row in rows)


def line(cells: Sequence[Any]) -> str:
    """Write one row.

    The writer quotes the signs that end its lines and no others, so it is left its own
    two; a lone carriage return in a file's name would else break the table.
    """
    sink = io.StringIO(newline="")
    csv.writer(sink).writerow(cells)
    return sink.getvalue().removesuffix("\r\n") + "\n"
