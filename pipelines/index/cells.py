"""What the cells of a manifest's row say, as people write them.

A cell that makes no sense is an error that names its column and quotes what is written.
"""

from typing import Any, Final

from nostalgin_core.catalogue import decimal
from nostalgin_core.records import Front

ASSUMED_WIDTH_M: Final = 7.62  # 25 feet, the common lot of New York
QUOTED: Final = 40  # letters
MOST_SIDES, MOST_FRONTS = 99, 9999  # of a ring; no block has more
LEAST_M, MOST_M = 1.0, 400.0  # of a front's width or depth
MOST_STOREYS: Final = 110  # the tallest house of the century
YES: Final = ("true", "1", "yes")
NO: Final = ("false", "0", "no", "")


def text(cells: dict[str, Any], name: str) -> str:
    """Read a cell of words; a missing one is empty."""
    return str(cells.get(name) or "").strip()


def as_written(cells: dict[str, Any], name: str) -> str:
    """Read a cell in which blanks may be part of a name; one of blanks is empty."""
    return str(cells[name]) if text(cells, name) else ""


def front_from(cells: dict[str, Any]) -> Front | None:
    """Read the front of a row.

    Raises:
        ValueError: if a cell holds no number where one is needed.
    """
    if not text(cells, "front_id"):
        return None
    width_m = length(cells, "width_m")
    return Front(
        front_id=text(cells, "front_id"),
        block=needed(cells, "block"),
        lot=needed(cells, "lot"),
        ring=count(cells, "ring", MOST_SIDES),
        side=count(cells, "side", MOST_SIDES),
        rank=count(cells, "rank", MOST_FRONTS),
        street=text(cells, "street"),
        address=text(cells, "address"),
        width_m=ASSUMED_WIDTH_M if width_m is None else width_m,
        depth_m=length(cells, "depth_m"),
        width_assumed=width_m is None or flag(cells, "width_assumed"),
        storeys=storeys(cells),
    )


def needed(cells: dict[str, Any], name: str) -> str:
    """Read a cell that may not be empty."""
    if not text(cells, name):
        raise ValueError(f"{name} is empty")
    return text(cells, name)


def count(cells: dict[str, Any], name: str, most: int) -> int:
    """Read a whole number from 0 to `most`; an empty cell counts as 0."""
    value = number(cells, name) or 0.0
    if value != int(value) or value > most:
        raise ValueError(f"{name} is {shown(cells, name)}, not a count up to {most}")
    return int(value)


def length(cells: dict[str, Any], name: str) -> float | None:
    """Read a length in metres that a front may have; an empty cell tells none."""
    value = number(cells, name)
    if value is not None and not LEAST_M <= value <= MOST_M:
        limits = f"{LEAST_M:g} to {MOST_M:g} metres"
        raise ValueError(f"{name} is {shown(cells, name)}, not {limits}")
    return value


def storeys(cells: dict[str, Any]) -> float | None:
    """Read how many storeys a building has; an empty cell tells none."""
    value = number(cells, "storeys")
    if value is not None and not 1 <= value <= MOST_STOREYS:
        limits = f"1 to {MOST_STOREYS} storeys"
        raise ValueError(f"storeys is {shown(cells, 'storeys')}, not {limits}")
    return value


def number(cells: dict[str, Any], name: str) -> float | None:
    """Read a number that is finite and not negative; None for an empty cell."""
    written = str(cells.get(name) if cells.get(name) is not None else "").strip()
    if not written:
        return None
    try:
        value = float(decimal(written).replace("_", "?"))  # Python parts digits by it
    except ValueError as problem:
        raise ValueError(f"{name} is {shown(cells, name)}, no number") from problem
    if not 0 <= value < float("inf"):
        raise ValueError(f"{name} is {shown(cells, name)}, not a length or a count")
    return value


def shown(cells: dict[str, Any], name: str) -> str:
    """Quote a cell in a message, which a huge one would drown."""
    return quoted(str(cells[name]).strip())


def quoted(words: str) -> str:
    """Quote the beginning of what is written."""
    return repr(words if len(words) <= QUOTED else f"{words[:QUOTED]}...")


def flag(cells: dict[str, Any], name: str) -> bool:
    """Read yes or no."""
    written = (
        str(cells.get(name) if cells.get(name) is not None else "").strip().lower()
    )
    if written in YES:
        return True
    if written in NO:
        return False
    raise ValueError(f"{name} is {quoted(written)}, neither true nor false")
