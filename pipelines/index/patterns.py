"""What a profile's tables may say: keys, types, patterns that tell block and lot."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Final

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from nostalgin_core import expression
from nostalgin_core.catalogue import Naming
from pipelines.index import watermarks
from pipelines.index.images import Nothing
from pipelines.index.profiles import ARCHIVES, Beside, Profile

MOST_PATTERNS: Final = 20
NEEDED: Final = ("block", "lot")
KNOWN: Final = frozenset((*NEEDED, "borough", "view"))
LONGEST_KEY: Final = 60  # letters of a key that are shown
REMEDIES: Final = {  # by pydantic's names
    "extra_forbidden": "not a key of a profile; docs/placards.md lists them",
    "list_type": "not a list: write ['...']",
    "string_type": "not a text: put it in single quotes",
    "bool_type": "neither true nor false: write one, without quotes",
    "model_type": "not a table: write [names] or [board] on a line of its own",
    "too_long": f"more than {MOST_PATTERNS} patterns: join some by |",
}


def pattern(given: str) -> str:
    """Insist on a pattern that tells block and lot.

    Raises:
        ValueError: if it is none; the words say why, and the remedy.
    """
    try:
        named = expression.groups(given)
    except ValueError as problem:
        remedy = "write a regular expression as RE2 has them, in single quotes"
        raise ValueError(f"no pattern: {problem}; {remedy}") from problem
    lacking = [one for one in NEEDED if one not in named]
    if lacking:
        raise ValueError(f"no group {lacking[0]}: write (?P<{lacking[0]}>...)")
    odd = sorted(named - KNOWN)
    if odd:
        known = ", ".join(sorted(KNOWN))
        raise ValueError(f"group {odd[0]} is not known: name it one of {known}")
    return given


Pattern = Annotated[str, AfterValidator(pattern)]
Patterns = Annotated[list[Pattern], Field(max_length=MOST_PATTERNS)]


class Strict(BaseModel):
    """A table of which every key is known, and of the right type."""

    model_config = ConfigDict(extra="forbid", strict=True)


class Names(Strict):
    """What file names tell."""

    patterns: Patterns = []
    without_list: Patterns = []


class Board(Strict):
    """What boards are like."""

    present: bool = False
    pattern: Pattern | None = None


def named(given: str) -> str:
    """Insist on a watermark that is known.

    Raises:
        ValueError: if it is not; the words name those that are.
    """
    if given not in watermarks.known():
        known = ", ".join(watermarks.known())
        raise ValueError(f"not a watermark that is known: write one of {known}")
    return given


class Mark(Strict):
    """What copies bear that no camera saw."""

    known: Annotated[str, AfterValidator(named)] | None = None
    file: str | None = None


class Told(Strict):
    """A whole profile."""

    names: Names = Names()
    board: Board = Board()
    watermark: Mark = Mark()


def of_cells(cells: Mapping[str, Any], path: Path, held: Beside) -> Profile:
    """Make a profile of what TOML says.

    Raises:
        Nothing: if it makes no sense.
    """
    try:
        told = Told.model_validate(cells)
    except ValidationError as problem:
        raise Nothing(f"{path}: {reason(problem)}") from problem
    board = told.board
    if board.pattern and not board.present:
        raise Nothing(f"{path}: board.pattern: of no board; write present = true, too")
    patterns = tuple(told.names.patterns), tuple(told.names.without_list)
    naming = Naming(*patterns, shipped=path.parent == ARCHIVES)
    mark, own = told.watermark.known or "", own_mark(told.watermark, path, held)
    return Profile(path.stem, naming, board.present, board.pattern or "", mark, own)


def own_mark(told: Mark, path: Path, held: Beside) -> bytes:
    """Read the watermark that an archive learnt itself, if a profile names one.

    Raises:
        Nothing: if it can't be read, or is none.
    """
    if told.file is None:
        return b""
    if told.known:
        raise Nothing(f"{path}: watermark.file: beside `known`; write one of them")
    try:
        return watermarks.own(held(told.file))
    except (OSError, ValueError) as problem:
        why = getattr(problem, "strerror", None) or problem
        words = "name a file that `nostalgin watermark` wrote, beside the profile"
        raise Nothing(f"{path}: watermark.file: {why}; {words}") from problem


def numbered(place: int) -> str:
    """Count a place in a list as people do."""
    return f"number {place + 1}"


def reason(problem: ValidationError) -> str:
    """Tell the first key that is wrong, why, and the remedy."""
    first = problem.errors(include_url=False, include_input=False)[0]
    where = ".".join(
        one if isinstance(one, str) else numbered(one) for one in first["loc"]
    )
    where = where if len(where) <= LONGEST_KEY else f"{where[:LONGEST_KEY]}..."
    words = REMEDIES.get(first["type"], first["msg"].removeprefix("Value error, "))
    return f"{where}: {words}"
