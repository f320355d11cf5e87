"""Comma-separated values as people and spreadsheets write them, read or refused.

A mark at the start, any line ends, quoted line breaks and empty lines are all read, and
semicolons or tabs in the place of commas, as spreadsheets of many countries save. An
empty line is a row without cells, so that rows keep the numbers that a spreadsheet
shows.
"""

import contextlib
import csv
import io
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Final

from pipelines.index.held import Cells, Held, shared

# What a spreadsheet takes for a formula, which may run a program, and the apostrophe
# that makes text of it; numbers are none, whatever their sign.
FORMULA: Final = re.compile(r"'*[=+\-@\t\r\n\uff1d\uff0b\uff0d\uff20]")
NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE)
MOST_CELL: Final = 2**31 - 1  # letters; what is too long is named by its row later
MOST_LINE: Final = 20_000_000  # letters
MOST_ROWS: Final = 5_000_000
MOST_HEADER: Final = 65_536  # letters that tell what parts the cells
SEPARATORS: Final = (",", ";", "\t")
OTHERS: Final = re.compile(r"[|]")  # what parts cells in dialects that are not read
QUOTED: Final = re.compile(r'"[^"]*("|$)')


class NoTable(ValueError):  # noqa: N818 - it reads as what it is about
    """Bytes that are no table, with the remedy."""


def parsed(data: bytes, *, ours: bool = False) -> tuple[list[str], Held]:
    """Read the names of the columns, and the rows below them.

    Cells are parted by whichever of `SEPARATORS` is most often in the header, outside
    quotes; by commas, if none is more often there. In a table of `ours` the apostrophes
    are taken off that `written` put before what a spreadsheet would run.

    Raises:
        NoTable: if it is no UTF-8, has a broken quote, parts its cells by other signs,
            names two columns alike, or is too large.
    """
    table: list[list[str]] = []
    try:
        text = data.decode("utf-8-sig")
        read = short(io.StringIO(text, newline=""))
        with long_cells():
            reader = csv.reader(read, delimiter=separator(text), strict=True)
            for row in shared(reader):
                if len(table) > MOST_ROWS:
                    raise NoTable(f"has more than {MOST_ROWS:,} rows: part it")
                table.append([*map(bare, row)] if ours else row)
    except UnicodeDecodeError as problem:
        raise NoTable(f"is no UTF-8 ({problem}): save it as CSV in UTF-8") from problem
    except csv.Error as problem:
        where = f"row {len(table) + 1}: {problem}"
        raise NoTable(f"is no CSV ({where}): mend its quotes") from problem
    names = table.pop(0) if table else []
    if len(names) == 1 and (mark := OTHERS.search(names[0])):
        raise NoTable(f"parts its cells by {mark[0]!r}: save it with commas")
    twice = [name for name, count in Counter(names).items() if name and count > 1]
    if twice:
        raise NoTable(f"has two columns {twice[0]!r}: rename or delete one of them")
    return names, Held(names, table)


def separator(text: str) -> str:
    """Find what parts a table's cells: the sign that its header has most of."""
    header = QUOTED.sub("", text[:MOST_HEADER]).lstrip("\r\n")
    names = re.split(r"[\r\n]", header, maxsplit=1)[0]
    return max(SEPARATORS, key=names.count)


@contextlib.contextmanager
def long_cells() -> Iterator[None]:
    """Let cells be longer than Python's limit, at which it gives up the whole table."""
    before = csv.field_size_limit(MOST_CELL)
    try:
        yield
    finally:
        csv.field_size_limit(before)


def short(lines: Iterable[str]) -> Iterator[str]:
    """Pass lines on, but none of which a row would take a machine's memory.

    Raises:
        NoTable: if there is such a line.
    """
    for number, one in enumerate(lines, 1):
        if len(one) > MOST_LINE:
            raise NoTable(f"line {number} has more than {MOST_LINE:,} letters: mend it")
        yield one


def blank(cells: Cells) -> bool:
    """Tell whether nothing is written in a row."""
    beyond = cells.get(None) or ()
    every = [*(cell for name, cell in cells.items() if name is not None), *beyond]
    return not any(str(cell).strip() for cell in every if cell is not None)


def written(names: Sequence[str], rows: Iterable[Cells]) -> str:
    """Write a table that `parsed` reads back, whatever line breaks its cells hold."""
    return lines([names, *([row.get(name) for name in names] for row in rows)])


def lines(rows: Iterable[Iterable[Any]]) -> str:
    """Write the lines of a table, each of some cells.

    The writer quotes the signs that end its lines and no others, so it is left its own
    two; a lone carriage return in a file's name would else break the table.
    """
    sink = Lines()
    csv.writer(sink).writerows(map(harmless, row) for row in rows)
    return "".join(sink.written)


class Lines:
    """What a writer of CSV writes a line at a time, each with our own end."""

    def __init__(self) -> None:
        """Begin with none."""
        self.written: list[str] = []

    def write(self, line: str) -> None:
        """Take one line."""
        self.written.append(line.removesuffix("\r\n") + "\n")


def harmless(cell: Any) -> Any:
    """Put an apostrophe before text that a spreadsheet would run."""
    text = isinstance(cell, str) and FORMULA.match(cell) and not NUMBER.fullmatch(cell)
    return f"'{cell}" if text else cell


def bare(cell: str) -> str:
    """Take off the apostrophe that `harmless` put there."""
    return cell[1:] if cell[:1] == "'" and FORMULA.match(cell) else cell
