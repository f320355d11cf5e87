"""Lists that are JSON: 1940s.nyc's photographs, OldNYC's, GeoJSON, and plain objects.

Each object becomes a row of the columns that every list is read by (`catalogue`); what
it tells beside is kept under its own name. An object that is not as its kind says is a
rejection by itself.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from nostalgin_core.records import Rejection

Row = dict[str, str]
LONGEST_PLACE: Final = 48  # letters of a place that photographs are gathered under
HOLDERS: Final = ("photos", "items", "records", "rows", "data")  # of a list of objects


class NoList(ValueError):  # noqa: N818 - it reads as what it is about
    """Bytes that are no list, with the remedy."""


class Lenient(BaseModel):
    """An object that may tell more, which is kept."""

    model_config = ConfigDict(extra="allow", coerce_numbers_to_str=True)

    def more(self) -> Row:
        """Write all that has no field of its own."""
        return {name: text(one) for name, one in (self.model_extra or {}).items()}


class Tax1940s(Lenient):
    """A photograph as 1940s.nyc tells it."""

    identifier: str
    block: str | None = None
    lot: str | None = None
    borough: str | None = None
    address: str | None = None
    number: str | None = Field(None, alias="bldgNumberStart")
    last_number: str | None = Field(None, alias="bldgNumberEnd")
    street: str | None = Field(None, alias="streetName")
    side: str | None = Field(None, alias="sideOfStreet")
    collection: str | None = None  # a year: whose they are it does not tell

    def row(self) -> Row:
        """Write it as a list's row."""
        ends = [one for one in (self.number, self.last_number) if one]
        numbers = "-".join(dict.fromkeys(ends)) or (self.address or "")
        return self.more() | {
            "photo": self.identifier,
            "block": self.block or "",
            "lot": self.lot or "",
            "borough": self.borough or "",
            "address": numbers,
            "street": self.street or "",
            "street_side": self.side or "",
            "series": self.collection or "",
        }


class OldNyc(Lenient):
    """A photograph as OldNYC tells it: a place and no lot."""

    id: str
    title: str = ""
    location: str | None = None
    date: str | None = None
    url: str | None = Field(None, alias="preferred_url")

    def row(self) -> Row:
        """Write it as a list's row; photographs of one place stand in one row."""
        place = " ".join((self.location or self.title).replace("/", " ").split())
        return self.more() | {
            "photo": self.id,
            "block": place[:LONGEST_PLACE],
            "lot": self.id if place else "",
            "title": self.title,
            "date": self.date or "",
            "source_url": self.url or "",
        }


class Plain(Lenient):
    """An object whose names are a list's columns."""

    def row(self) -> Row:
        """Write it as a list's row."""
        return self.more()


@dataclass(frozen=True)
class Objects:
    """The rows of a list, and the objects that make none; both numbered alike."""

    rows: tuple[Row, ...]
    rejections: tuple[Rejection, ...]


def rows(data: bytes, name: str) -> Objects:
    """Read a list of objects: an array, one a line, or a GeoJSON collection.

    Raises:
        NoList: if it is none.
    """
    found, rejections = [], []
    for number, one in enumerate(objects(data), 1):
        try:
            found.append(written(kind(one).model_validate(one).row()))
        except (ValidationError, UnicodeEncodeError) as problem:
            where, why = f"{name} record {number}", told(problem)
            rejections.append(Rejection(where, "catalogue", "nonsense record", why))
            found.append({})  # so that the others keep their numbers
    return Objects(tuple(found), tuple(rejections))


def written(row: Row) -> Row:
    """Give a row that can be written down.

    Raises:
        UnicodeEncodeError: if it holds half of a letter, as JSON's escapes may.
    """
    "".join((*row, *row.values())).encode()
    return row


def kind(one: Any) -> type[Tax1940s] | type[OldNyc] | type[Plain]:
    """Tell whose an object is by the names that only they use."""
    if not isinstance(one, dict):
        return Plain  # which refuses it
    if "identifier" in one and one.keys() & {
        *("bldgNumberStart", "streetName", "sideOfStreet", "effectiveGeocode"),
        "collection",
    }:
        return Tax1940s
    if "id" in one and one.keys() & {"photo_url", "preferred_url", "back_id"}:
        return OldNyc
    return Plain


def objects(data: bytes) -> Iterator[Any]:
    """List the objects of a JSON text, of one a line, or of a GeoJSON collection.

    Raises:
        NoList: if it is none.
    """
    whole = loaded(data)
    if isinstance(whole, dict):
        if whole.get("type") == "FeatureCollection":
            features = whole.get("features")
            yield from map(feature, features if isinstance(features, list) else [])
            return
        inner = [whole[one] for one in HOLDERS if isinstance(whole.get(one), list)]
        yield from inner[0] if inner else [whole]
    elif isinstance(whole, list):
        yield from whole
    else:
        raise NoList("is no list of objects: name a file of photographs' records")


def loaded(data: bytes) -> Any:
    """Read a JSON text, or one a line.

    Raises:
        NoList: if it is neither.
    """
    try:
        try:
            return json.loads(data.decode("utf-8-sig"))
        except json.JSONDecodeError:
            lines = data.decode("utf-8-sig").split("\n")  # texts hold other line ends
            return [json.loads(line) for line in lines if line.strip()]
    except (ValueError, RecursionError) as problem:
        raise NoList(f"is no JSON ({problem}): save it as JSON in UTF-8") from problem


def feature(one: Any) -> Any:
    """Write a GeoJSON feature as a plain object with its place."""
    if not isinstance(one, dict) or not isinstance(one.get("properties"), dict):
        return one
    made = dict(one["properties"])
    if one.get("id") is not None:
        made.setdefault("id", one["id"])
    geometry = one.get("geometry")
    if isinstance(geometry, dict) and geometry.get("type") == "Point":
        point = geometry.get("coordinates")
        if isinstance(point, list) and len(point) >= 2:
            made |= {"lon": point[0], "lat": point[1]}
    return made


def text(value: Any) -> str:
    """Write a value as a cell: what is no text or number stays JSON."""
    if value is None:
        return ""
    if isinstance(value, (dict, list, bool)):
        return json.dumps(value, ensure_ascii=False)
    return str(value)


def told(problem: ValidationError | UnicodeEncodeError) -> str:
    """Tell the first thing that is wrong with a record, and the remedy."""
    if isinstance(problem, UnicodeEncodeError):
        half = ascii(problem.object[problem.start])
        return f"it has a letter that is none, {half}; mend the record"
    first = problem.errors(include_url=False, include_input=False)[0]
    where = ".".join(map(str, first["loc"])) or "it"
    return f"{where}: {first['msg'].casefold()}; mend the record"
