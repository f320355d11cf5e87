"""IIIF Presentation 2.1 and 3.0: a manifest or a collection becomes photographs.

Both versions are read by one lenient schema: what is needed to show a photograph and to
say whose it is must be there, all else may be as it likes, for few servers keep to the
letter. https://iiif.io/api/presentation/3.0/, https://iiif.io/api/presentation/2.1/ and
https://iiif.io/api/image/3.0/ say what the fields mean.
"""

import html
import re
from collections.abc import Iterator
from typing import Annotated, Any, Final

from pydantic import AliasChoices, BaseModel, BeforeValidator, ConfigDict, Field

LONGEST_PX: Final = 4096  # side of a picture that is asked for; networks see 1024
LEVEL_0: Final = "level0"


def words(value: Any) -> str:
    """Read a text in whatever languages and wrapping either version has it."""
    if isinstance(value, dict):
        if "@value" in value:
            return words(value["@value"])
        return words(next(iter(value.values()), ""))
    if isinstance(value, list) and value and all(isinstance(v, dict) for v in value):
        return words(value[0])  # one text in several languages
    if isinstance(value, list):
        return "; ".join(filter(None, map(words, value)))
    text = re.sub(r"<[^<>]*>", " ", str(value if value is not None else ""))
    whole = text.encode(errors="replace").decode()  # JSON may tell half of a letter
    return " ".join(html.unescape(whole).split())


def listed(value: Any) -> Any:
    """Take one thing for a list of one."""
    return value if isinstance(value, list) else [] if value is None else [value]


def either(*names: str) -> Any:
    """Name a field as each version calls it."""
    return Field(None, validation_alias=AliasChoices(*names))


class Lenient(BaseModel):
    """What may hold more than we read."""

    model_config = ConfigDict(extra="ignore", str_max_length=100_000)


class Service(Lenient):
    """An image server."""

    id: str | None = either("id", "@id")
    type: str | None = either("type", "@type")
    context: Any = either("@context")
    profile: Any = None


class Resource(Lenient):
    """A picture, or a choice of several."""

    id: str | None = either("id", "@id")
    type: str | None = either("type", "@type")
    service: Annotated[list[Service], BeforeValidator(listed)] = []
    default: "Resource | None" = None
    items: list["Resource"] = []


class Annotation(Lenient):
    """What is painted on a canvas."""

    motivation: Any = "painting"
    body: Annotated[list[Resource], BeforeValidator(listed)] = Field(
        [], validation_alias=AliasChoices("body", "resource")
    )


class Page(Lenient):
    """Annotations of version 3.0."""

    items: list[Annotation] = []


class Pair(Lenient):
    """A label and a value, for people."""

    label: Any = None
    value: Any = None


class Told(Lenient):
    """What is told of a canvas or a whole manifest."""

    id: str | None = either("id", "@id")
    label: Any = None
    metadata: list[Pair] = []
    rights: Any = either("rights", "license")
    statement: Any = either("requiredStatement", "attribution")
    homepage: Any = either("homepage", "related")
    date: Any = either("navDate")


class Canvas(Told):
    """One photograph."""

    items: list[Page] = []
    images: list[Annotation] = []


class Sequence(Lenient):
    """Canvases of version 2.1."""

    canvases: list[Canvas] = []


class Document(Told):
    """A manifest or a collection."""

    type: str = Field(validation_alias=AliasChoices("type", "@type"))
    items: list[dict[str, Any]] = []
    sequences: list[Sequence] = []
    manifests: list[dict[str, Any]] = []
    collections: list[dict[str, Any]] = []
    members: list[dict[str, Any]] = []

    @property
    def collects(self) -> bool:
        """Tell whether it leads to others."""
        return self.type.rpartition(":")[2] == "Collection"

    def canvases(self) -> Iterator[Canvas]:
        """List a manifest's photographs; each is looked at as it is needed."""
        for one in self.items:
            yield Canvas.model_validate(one)
        for sequence in self.sequences[:1]:  # others are other orders of the same
            yield from sequence.canvases

    def others(self) -> list[str]:
        """List the addresses that a collection leads to."""
        every = [*self.items, *self.manifests, *self.collections, *self.members]
        found = [one.get("id") or one.get("@id") for one in every]
        return list(dict.fromkeys(one for one in found if isinstance(one, str)))


def picture(canvas: Canvas) -> Resource | None:
    """Find a canvas's picture: the first that is painted on it."""
    annotations = [*(a for page in canvas.items for a in page.items), *canvas.images]
    for annotation in annotations:
        if "painting" not in words(annotation.motivation).casefold():
            continue
        for one in annotation.body:
            chosen = one.default or (one.items[0] if one.items else one)
            if chosen.id:
                return chosen
    return None


def image_service(resource: Resource) -> Service | None:
    """Find the image server of a picture."""
    for one in resource.service:
        told = f"{one.type} {words(one.context)} {words(one.profile)}"
        if one.id and ("ImageService" in told or "iiif.io/api/image" in told):
            return one
    return None


class Size(Lenient):
    """A size that a server has ready."""

    width: int = Field(gt=0)
    height: int = Field(gt=0)


class Info(Size):
    """An image server's info.json."""

    context: Any = either("@context")
    profile: Any = None
    sizes: list[Size] = []
    max_width: int | None = either("maxWidth")
    max_height: int | None = either("maxHeight")
    max_area: int | None = either("maxArea")


def request(service: str, info: Info, *, longest_px: int = LONGEST_PX) -> str:
    """Write the request for a whole picture, no larger than is of use or allowed.

    A server of level 0 has some sizes ready and no others: the largest of these.
    """
    third = "image/3" in words(info.context)
    fits = [one for one in info.sizes if max(one.width, one.height) <= longest_px]
    if LEVEL_0 in words(info.profile) and info.sizes:
        own = max(fits or info.sizes[:1], key=lambda one: one.width)
        w, h = own.width, own.height
    else:
        shares = [1.0, longest_px / max(info.width, info.height)]
        if info.max_width:
            shares.append(info.max_width / info.width)
            shares.append((info.max_height or info.max_width) / info.height)
        if info.max_area:
            shares.append((info.max_area / (info.width * info.height)) ** 0.5)
        w = max(int(info.width * min(shares)), 1)
        h = max(int(info.height * min(shares)), 1)
    if (w, h) == (info.width, info.height):
        size = "max" if third else "full"
    else:
        size = f"{w},{h}" if third else f"{w},"
    return f"{service.rstrip('/')}/full/{size}/0/default.jpg"


def cells(canvas: Canvas, manifest: Told) -> dict[str, str]:
    """Write what is told of a photograph as a list's row; its own words come first."""
    row: dict[str, str] = {}
    for told in (canvas, manifest):
        for pair in told.metadata:
            label, value = words(pair.label), words(pair.value)
            if label and value:
                row.setdefault(label, value)
        known = {
            "title": words(told.label),
            "credit": credit(told.statement),
            "license": words(told.rights),
            "source_url": address(told.homepage),
            "date": words(told.date),
        }
        taken = {name.casefold() for name in row}
        row |= {n: text for n, text in known.items() if text and n not in taken}
    return row


def credit(statement: Any) -> str:
    """Read whom to name: 3.0 has a label and a value, 2.1 words alone."""
    if isinstance(statement, dict) and "value" in statement:
        return words(statement["value"])
    return words(statement)


def address(homepage: Any) -> str:
    """Read the page of a photograph."""
    first = next(iter(listed(homepage)), None)
    if isinstance(first, dict):
        first = first.get("id") or first.get("@id")
    return first if isinstance(first, str) else ""
