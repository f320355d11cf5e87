"""What is wrong with a correction, told to whoever wrote it: column, value, remedy."""

from collections.abc import Sequence
from typing import Any, Final

from pydantic import ValidationError

from pipelines.index.cells import quoted

UNITS: Final = {
    "width_m": "in metres",
    "height_m": "in metres",
    "target": "in pixels from the photo's left side",
    "order": "as a rank in its ring",
}
EXAMPLES: Final = {"width_m": "6.1", "height_m": "18", "target": "412", "order": "12.5"}
MOST_NAMES: Final = 8  # that a message lists
DESCRIBED: Final = "docs/corrections.md describes them"


def limited(what: str, value: str, low: float, high: float) -> None:
    """Insist on a number between two others.

    Raises:
        ValueError: if it is none, or beyond them; with the unit, and an example.
    """
    pointed = value.replace(",", ".")
    example = pointed if "," in value and numeric(pointed) else EXAMPLES[what]
    remedy = f"write {what} {UNITS[what]} with a decimal point, as {example}"
    if not value:
        raise ValueError(f"value is empty: {remedy}")
    if not numeric(value):
        raise ValueError(f"value is {quoted(value)}, no number: {remedy}")
    if not low <= float(value) <= high:
        limits = f"{what} is from {low:g} to {high:g}, {UNITS[what]}"
        raise ValueError(f"value is {quoted(value)}, but {limits}: mend the value")


def numeric(value: str) -> bool:
    """Tell whether a text is a number; nan is none."""
    try:
        return float(value) == float(value)
    except ValueError:
        return False


def no_lot(what: str, value: str) -> str:
    """Say that a value is no block and lot."""
    remedy = f"write {what} as block-lot, as 993-9"
    told = f"is {quoted(value)}, no block and lot" if value else "is empty"
    return f"value {told}: {remedy}"


def lacking(missing: Sequence[str], names: Sequence[str]) -> str:
    """Say which columns a table has not, and which it has."""
    shown = ", ".join(quoted(one) for one in names[:MOST_NAMES])
    columns = "column" if len(missing) == 1 else "columns"
    return f"lacks the {columns} {', '.join(missing)}: it has {shown}; {DESCRIBED}"


def reason(problem: ValueError) -> str:
    """Tell the first thing that is wrong with a correction."""
    if not isinstance(problem, ValidationError):
        return str(problem)
    first = problem.errors(include_url=False)[0]
    where = ".".join(map(str, first["loc"]))
    if first["type"] == "value_error":
        told = first["msg"].removeprefix("Value error, ")
        return f"{where} {told}" if where else told
    return f"{where} {unfit(first)}: {DESCRIBED}"


def unfit(first: Any) -> str:
    """Say why a cell can't be what its column holds."""
    kind, given = first["type"], first["input"]
    if kind == "missing" or given is None:
        return "is missing: fill it in"
    if kind == "literal_error":
        allowed = first["ctx"]["expected"].replace("'", "")
        return f"is {quoted(str(given))}: write {allowed}"
    if kind == "string_unicode":
        return "has a letter that is none: write it anew"
    return f"is {quoted(str(given))}, neither words nor a number: write one of them"
