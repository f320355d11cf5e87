"""Lengths as an archive's list gives them: in metres, or in feet that lost their marks.

Doubtful feet are left out, for the house numbers give a guess (`assumed_width`); metres
were written for this purpose, so nonsense there is an error. Lengths of a building that
is younger than its photograph are left out, too.
"""

import re
from collections.abc import Mapping
from typing import Final

from nostalgin_core.address import house_numbers

FOOT_M: Final = 0.3048
NARROWEST_FT, WIDEST_FT = 8.0, 450.0  # of a front; beyond, a digit was lost
MOST_SIDES: Final = 99  # of a ring, and rings of a block
MOST_STOREYS: Final = 110  # the tallest house of the century
LOT_FT: Final = 25.0  # the common lot of New York: 25 by 100 feet
DECIMAL_COMMA: Final = re.compile(r"([+-]?\d{1,9}),(\d{1,2}|\d{4,9})")


def feet(written: str) -> float | None:
    """Read feet and inches that a spreadsheet mangled; None where they make no sense.

    The archive wrote feet.inches, and lost hundreds on the way:

    - 98.09 is 98 feet 9 inches, 203.10 is 203 feet 10 inches (12 or more after the
      point can't be inches, and counts as a decimal fraction);
    - 20.1 is 20 feet 10 inches, for the spreadsheet dropped the last zero;
    - under 8 it is hundreds of feet: 0.60 is 60 feet, 1.25 is 125, 2.43 is 243.

    What is then under 8 feet or over 450 is no front: a digit was lost elsewhere.
    """
    bare = written.strip().removesuffix("'")
    found = re.fullmatch(r"(\d{0,9})(?:\.(\d{0,9}))?", bare)
    if found is None or not written.strip(" .'"):
        return None
    whole, digits = int(found[1] or 0), found[2] or ""
    if whole < NARROWEST_FT:
        length = 100.0 * float(f"{whole}.{digits or 0}")
    else:
        inches = int({"1": "10"}.get(digits, digits or "0"))
        length = whole + inches / 12 if inches < 12 else float(f"{whole}.{digits}")
    return length if NARROWEST_FT <= length <= WIDEST_FT else None


def assumed_width(address: str) -> float:
    """Guess a front's width in metres from how many house numbers it takes.

    One number is a common lot of 25 feet; each further one of the same parity adds 20,
    for later numbers were given to narrower lots.
    """
    numbers = house_numbers(address)
    more = (numbers[1] - numbers[0]) // 2 if numbers else 0
    return round(FOOT_M * (LOT_FT + 20.0 * min(more, 10)), 3)


def length(
    cells: Mapping[str, str], metres: str, mangled: str
) -> tuple[float | None, list[str]]:
    """Read a length in metres, or in the archive's feet; doubts are no rejections.

    Raises:
        ValueError: "reason: remedy", if the metres make no sense.
    """
    if cells.get(metres):
        value = number(cells, metres)
        if value is None or not 1.0 <= value <= 400.0:
            raise ValueError(
                f"nonsense {metres}: {cells[metres]!r}; write 1 to 400 metres"
            )
        return value, []
    written = cells.get(mangled, "")
    if not written:
        return None, []
    length_ft = feet(written)
    if length_ft is None:
        return None, [f"{mangled} {written!r} makes no sense; it is left out"]
    return round(length_ft * FOOT_M, 3), []


def floors(cells: Mapping[str, str]) -> tuple[float | None, list[str]]:
    """Read how many storeys a list gives a building; nonsense is left out, and told."""
    written = cells.get("storeys", "")
    if not written:
        return None, []
    found = re.fullmatch(r"\d{1,3}(\.\d{1,9})?", written)
    if found is None or not 1 <= float(written) <= MOST_STOREYS:
        return None, [f"storeys {written[:40]!r} make no sense; they are left out"]
    return float(written), []


def later_building(cells: Mapping[str, str]) -> str:
    """Say why the archive's lengths are not those of the building in the photograph."""
    built = re.match(r"\d{4}", cells.get("built", ""))
    taken = re.findall(r"\d{4}", cells.get("taken", ""))
    if not built or not taken or int(built[0]) <= int(taken[-1]):
        return ""
    if cells.get("width_m") or cells.get("depth_m"):
        return ""  # written for this purpose
    return f"its measures are of a building of {built[0]}; they are left out"


def decimal(written: str) -> str:
    """Write a number with a decimal point where there is a comma: 7,6 is 7.6.

    Of 1,234 nobody knows whether it is a thousand: it stays as it is written.
    """
    found = DECIMAL_COMMA.fullmatch(written.strip())
    return f"{found[1]}.{found[2]}" if found else written


def number(cells: Mapping[str, str], field: str) -> float | None:
    """Read a cell that holds a number of up to nine digits, or nothing.

    Raises:
        ValueError: "reason: remedy", if it holds something else.
    """
    written = decimal(cells.get(field, ""))
    if not written:
        return None
    if not re.fullmatch(r"\d{1,9}(\.\d{1,9})?", written):
        raise ValueError(f"nonsense {field}: {written[:40]!r}; write a number, as 7.62")
    return float(written)


def count(cells: Mapping[str, str], field: str) -> int | None:
    """Read a cell that counts sides or rings, or holds nothing.

    Raises:
        ValueError: "reason: remedy", if it is not 0 to 99.
    """
    value = number(cells, field)
    if value is not None and (value != int(value) or value > MOST_SIDES):
        raise ValueError(f"nonsense {field}: {cells[field]!r}; count from 0 to 99")
    return None if value is None else int(value)
