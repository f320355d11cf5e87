"""Corrections as people write them, a row each, in a file that `index` never touches.

photo,front_id,building_id,what,value,note
993_8.jpg,,,key,993-9,the board says so
,993-11-3,,width_m,6.1,measured on the atlas
,993-11-3,,order,12.5,stands between the fronts of rank 12 and 13
,,993-11,height_m,18,five storeys
993_8.jpg,,,target,412,the facade at x = 412 pixels
993_8.jpg,,,mask,"80,20 400,32 402,610 78,600",the outline of the whole front
993_8.jpg,,,quad,"80,20 400,32 402,610 78,600",its four corners
"""

import codecs
import hashlib
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final, Literal, Self

import numpy as np
from pydantic import (
    BaseModel,
    ConfigDict,
    field_validator,
    model_validator,
)

from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.corrections import shapes, words
from pipelines.index import comma
from pipelines.index.cells import LEAST_M, MOST_FRONTS, MOST_M
from pipelines.store import Store

CSV: Final = "corrections.csv"
JSONL: Final = ".jsonl"
LINES: Final = "corrections.jsonl"
NAMES: Final = (CSV, LINES)
CORRECTION_BYTES: Final = 50_000_000
LONGEST: Final = 1000  # letters of a cell
HIGHEST_M: Final = 320.0
FARTHEST_PX: Final = 100_000.0
# Of what each correction speaks, and within which limits its value lies.
SUBJECTS: Final = {
    "key": "photo",
    "placard": "photo",
    "target": "photo",
    "mask": "photo",
    "quad": "photo",
    "width_m": "front_id",
    "order": "front_id",
    "height_m": "building_id",
}
LIMITS: Final = {
    "width_m": (LEAST_M, MOST_M),
    "height_m": (2.5, HIGHEST_M),
    "order": (-1.0, MOST_FRONTS),
    "target": (0.0, FARTHEST_PX),
}

What = Literal[
    "key", "placard", "target", "mask", "quad", "width_m", "order", "height_m"
]
SHAPES: Final[dict[str, Callable[[str], np.ndarray]]] = {
    "mask": shapes.outline,
    "quad": shapes.quad,
}
UNREADABLE: Final = "unreadable file"
REQUIRED: Final = ("what", "value")
LONGEST_SHAPE: Final = 32_767  # letters: what a cell of a spreadsheet holds


class Correction(BaseModel):
    """One thing that somebody knows better."""

    model_config = ConfigDict(
        extra="ignore",
        frozen=True,
        coerce_numbers_to_str=True,
        str_strip_whitespace=True,
    )

    what: What
    value: str
    photo: str = ""
    front_id: str = ""
    building_id: str = ""
    note: str = ""
    row: str = ""  # which it is, in messages

    @field_validator("value", mode="before")
    @classmethod
    def flat(cls, value: object) -> object:
        """Write a list of points as a table has it."""
        if not isinstance(value, list):
            return value
        if len(value) > shapes.MOST:
            raise ValueError(f"has {len(value):,} points, more than {shapes.MOST:,}")
        if not all(isinstance(one, list) and len(one) == 2 for one in value):
            raise ValueError("is a list, but not of points: write [[x, y], [x, y] ...]")
        return " ".join(f"{x},{y}" for x, y in value)

    @model_validator(mode="after")
    def sensible(self) -> Self:
        """Insist on what it speaks of, and on a value that this may have."""
        self._short()
        if not self.subject:
            of = SUBJECTS[self.what]
            raise ValueError(f"{of} is empty: write of which {of} {self.what} tells")
        if self.what in SHAPES:
            try:
                SHAPES[self.what](self.value)
            except ValueError as problem:
                raise ValueError(f"{self.what} {problem}") from problem
        elif self.what in LIMITS:
            words.limited(self.what, self.value, *LIMITS[self.what])
        elif len(self.lot_key) != 2:
            raise ValueError(words.no_lot(self.what, self.value))
        return self

    def _short(self) -> None:
        """Refuse cells that no name or number fills."""
        for name in type(self).model_fields:
            most = LONGEST
            if name == "value" and self.what in SHAPES:
                most = LONGEST_SHAPE
            if len(getattr(self, name)) > most:
                raise ValueError(f"{name} has more than {most:,} letters: shorten it")

    @property
    def shape(self) -> str:
        """Give a value that is a shape as keys have it."""
        return shapes.written(SHAPES[self.what](self.value))

    @property
    def subject(self) -> str:
        """Name the photograph, front or building that it speaks of."""
        return str(getattr(self, SUBJECTS[self.what]))

    @property
    def about(self) -> tuple[str, str]:
        """Tell what is corrected: a board's reading is a photograph's key."""
        return ("key" if self.what == "placard" else self.what), self.subject

    @property
    def number(self) -> float:
        """Read a value that is a number."""
        return float(self.value)

    @property
    def lot_key(self) -> tuple[str, ...]:
        """Read a value that is a block and a lot: 993-8."""
        block, mark, lot = self.value.rpartition("-")
        parts = (block.strip(), lot.strip())
        return parts if mark and all(parts) else ()


@dataclass(frozen=True)
class Corrections:
    """What is corrected, what could not be read, and the bytes it was read from."""

    given: tuple[Correction, ...] = ()
    rejections: tuple[Rejection, ...] = ()
    sha256: str = ""  # empty: there are none
    superseded: tuple[tuple[Correction, str], ...] = ()  # and by which row

    @property
    def unreadable(self) -> tuple[Rejection, ...]:
        """Give the files of which not a row could be read."""
        return tuple(one for one in self.rejections if one.reason == UNREADABLE)


def read(store: Store) -> Corrections:
    """Read a city's corrections, each by itself; a bad one is named, with the remedy.

    Of two about the same thing the later counts.
    """
    found = [name for name in NAMES if store.exists(name)]
    return taken((n, partial(store.read_bytes, n, CORRECTION_BYTES)) for n in found)


def of_file(path: Path) -> Corrections:
    """Read one file of corrections: objects a line if it is called .jsonl, else CSV.

    Raises:
        OSError: if it can't be read.
    """
    data = bounded.read(path, CORRECTION_BYTES)
    return taken([(path.name, lambda: data)])


def taken(files: Iterable[tuple[str, Callable[[], bytes]]]) -> Corrections:
    """Read files one after the other, as if they were one."""
    given: dict[tuple[str, str], Correction] = {}
    rejections: list[Rejection] = []
    earlier: list[Correction] = []
    digest, some = hashlib.sha256(), False
    for name, read_bytes in files:
        some = True
        try:
            data = read_bytes()
            rows = lines(data) if name.endswith(JSONL) else table(data)
        except (OSError, ValueError) as problem:
            told = getattr(problem, "strerror", None)
            why = f"can't be read: {told}" if told else str(problem)
            why += "; mend the file, or move it away"
            rejections.append(Rejection(name, "corrections", UNREADABLE, why))
            continue
        digest.update(name.encode() + b"\0" + data)
        for number, row in rows:
            key = f"{name} row {number}"
            try:
                cells = of_line(row) if isinstance(row, bytes) else row
                one = Correction.model_validate(cells | {"row": key})
                before = given.get(one.about)
                earlier += [before] if before is not None else []
                given[one.about] = one
            except ValueError as problem:
                told = words.reason(problem)
                bad = Rejection(key, "corrections", "nonsense correction", told)
                rejections.append(bad)
    sha256 = digest.hexdigest() if some else ""
    superseded = tuple((one, given[one.about].row) for one in earlier)
    return Corrections(tuple(given.values()), tuple(rejections), sha256, superseded)


def table(data: bytes) -> list[tuple[int, dict[str, Any]]]:
    """List the rows of a CSV, as a spreadsheet counts.

    Raises:
        NoTable: if it is none.
    """
    names, rows = comma.parsed(data, ours=True)
    if names and (missing := [one for one in REQUIRED if one not in names]):
        raise comma.NoTable(words.lacking(missing, names))
    return [
        (number, {str(name): cell for name, cell in row.items() if name})
        for number, row in enumerate(rows, 2)
        if not comma.blank(row)
    ]


def lines(data: bytes) -> list[tuple[int, bytes]]:
    """List the lines of a text that say something; a newline alone ends one.

    A note may hold any other letter that ends lines somewhere.
    """
    every = data.removeprefix(codecs.BOM_UTF8).split(b"\n")
    return [(number, line) for number, line in enumerate(every, 1) if line.strip()]


def of_line(line: bytes) -> dict[str, Any]:
    """Read the object that a line is.

    Raises:
        ValueError: if it is none; it says how to mend it.
    """
    try:
        one = json.loads(line.decode())
    except UnicodeDecodeError as problem:
        raise ValueError("is not UTF-8: save the file as UTF-8") from problem
    except json.JSONDecodeError as problem:
        where = f"is no JSON from letter {problem.colno} on: {problem.msg}"
        raise ValueError(f"{where}; mend the line or take it out") from problem
    except ValueError as problem:  # which Python gives of thousands of digits
        raise ValueError("has a number that is too long: shorten it") from problem
    except RecursionError as problem:
        raise ValueError("is nested too deep: take the line out") from problem
    if not isinstance(one, dict):
        raise ValueError('is no object: write {"what": ..., "value": ...}')  # noqa: TRY004
    return one
