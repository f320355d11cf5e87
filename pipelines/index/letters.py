"""A table's bytes, in whatever encoding, become UTF-8; what was guessed is told.

What says by its mark or its form that it is UTF-8, UTF-16 or UTF-32 is read as that.
Other bytes are most probably what Western spreadsheets save as "CSV": Windows-1252,
which holds all letters of Latin-1. That is a guess, so the first line that needed it
is told as it was read.
"""

import codecs
import re
from typing import Final

WINDOWS: Final = "cp1252"
MARKS: Final = (  # in this order, as one begins like another
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
ENDS: Final = {"utf-16-le": slice(1, None, 2), "utf-16-be": slice(0, None, 2)}
SAMPLE: Final = 4096  # bytes that show whether every other one is empty
NO_TEXT: Final = re.compile("[\0-\x08\x0e-\x1f]")
EMPTY: Final = 0.25  # of all bytes: half of every other one
AROUND: Final = 20  # letters that are shown on either side
REMEDY: Final = "save it as CSV in UTF-8, or name its encoding by --encoding"


class Garbled(ValueError):  # noqa: N818 - it reads as what it is about
    """Bytes that are no text, or none of the encoding that was named."""


def utf8(data: bytes, encoding: str = "") -> tuple[bytes, str]:
    """Write a table's bytes as UTF-8; tell what was guessed, if anything was.

    Nothing is guessed of a table whose `encoding` is named, as Python names them.

    Raises:
        Garbled: if it is no text, or another's; with the remedy.
    """
    if encoding:
        return strictly(data, encoding), ""
    for mark, name in MARKS:
        if data.startswith(mark):
            return strictly(data, name), ""
    if sixteen := unmarked(data[:SAMPLE]):
        text = readable(strictly(data, sixteen).decode(), sixteen)
        return text.encode(), f"it has no mark: it is read as {sixteen.upper()}"
    try:
        data.decode()
    except UnicodeDecodeError:
        return of_windows(data)
    return data, ""


def strictly(data: bytes, encoding: str) -> bytes:
    """Take bytes for what they are said to be.

    Raises:
        Garbled: if they are not, or there is no such encoding.
    """
    try:
        text = data.decode(encoding)
    except LookupError as problem:
        words = "name it as Python does: utf-8, cp1252, utf-16, mac-roman"
        raise Garbled(f"can't be read: no encoding {encoding[:40]!r}; {words}") from (
            problem
        )
    except UnicodeError as problem:
        raise Garbled(f"is no {encoding} ({problem}): {REMEDY}") from problem
    return text.encode()


def unmarked(sample: bytes) -> str:
    """Tell which UTF-16 bytes are that do not say so; empty: none.

    Of Western letters every other byte is empty, and of other texts none is.
    """
    for name, part in ENDS.items():
        if sample[part].count(0) > EMPTY * len(sample):
            return name
    return ""


def of_windows(data: bytes) -> tuple[bytes, str]:
    """Read what is no UTF-8 as Windows-1252.

    Raises:
        Garbled: if a line of it is UTF-8, so that another is damaged; or if it is no
            text at all.
    """
    wrong, right = strange(data)
    if right:
        words = f"line {wrong} is no UTF-8, while line {right} is"
        raise Garbled(f"is damaged: {words}: mend that line, or {REMEDY}")
    try:
        text = readable(data.decode(WINDOWS), WINDOWS)
    except UnicodeDecodeError as problem:
        line = data.count(b"\n", 0, problem.start) + 1
        words = f"line {line} is neither that nor Windows-1252"
        raise Garbled(f"is no UTF-8: {words}: {REMEDY}") from problem
    line = text.split("\n", wrong)[wrong - 1]
    first = next(place for place, letter in enumerate(line) if not letter.isascii())
    shown = line[max(first - AROUND, 0) : first + AROUND].strip()
    words = f"line {wrong} is no UTF-8: all is read as Windows-1252 ({shown!r})"
    return text.encode(), f"{words}; if that is wrong, name its encoding by --encoding"


def strange(data: bytes) -> tuple[int, int]:
    """Number the first line that is no UTF-8, and the first that is and needs to be.

    Lines that any encoding reads alike are neither; 0: there is none.
    """
    wrong = right = 0
    for number, line in enumerate(data.split(b"\n"), 1):
        if line.isascii():
            continue
        try:
            line.decode()
            right = right or number
        except UnicodeDecodeError:
            wrong = wrong or number
        if wrong and right:
            break
    return wrong, right


def readable(text: str, encoding: str) -> str:
    """Insist on text that people wrote.

    Raises:
        Garbled: if it holds signs that no text has.
    """
    odd = NO_TEXT.search(text)
    if odd:
        line = text.count("\n", 0, odd.start()) + 1
        words = f"read as {encoding}, line {line} holds {odd[0]!r}"
        raise Garbled(f"is no text: {words}: {REMEDY}")
    return text
