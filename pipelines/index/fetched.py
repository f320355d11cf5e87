"""Photographs of a IIIF source, brought into the city folder once.

    CITY/fetched/<hash>.json           manifests, collections and info.json, by address
    CITY/photographs/<name>.jpg        the photographs, by their labels

What lies there is not asked for again: a second run needs no network. To bring it anew,
remove the file.
"""

import hashlib
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.index import iiif, lists, web
from pipelines.index.images import Nothing
from pipelines.index.objects import told
from pipelines.store import Store

DOCUMENTS: Final = "fetched"
PHOTOGRAPHS: Final = "photographs"
DOCUMENT_BYTES: Final = 50_000_000
MOST_DOCUMENTS: Final = 10_000
MOST_PHOTOGRAPHS: Final = 1_000_000
GIVE_UP: Final = 5  # photographs in a row that a server does not give
LONGEST: Final = 80  # letters of a file's name
# What a picture begins with; a server may call anything one.
PICTURES: Final = {
    b"\xff\xd8\xff": ".jpg",
    b"\x89PNG\r\n\x1a\n": ".png",
    b"II*\0": ".tif",
    b"MM\0*": ".tif",
    b"RIFF": ".webp",
    b"\0\0\0\x0cjP  ": ".jp2",
}
LOSSLESS_NAMES: Final = re.compile(r"[^\w.,()+-]+")


@dataclass
class Source:
    """A IIIF source and the city folder that keeps what it gave."""

    asked: str  # by a person: an address, or a file
    store: Store
    patience: web.Patience = field(default_factory=web.Patience)
    failed: int = 0  # in a row

    def document(self, where: str) -> Any:
        """Read a manifest, a collection or an info.json.

        Raises:
            Unfetched: if there is none.
        """
        if where == self.asked and not web.is_web(where):
            try:
                data = bounded.read(where, DOCUMENT_BYTES)
            except OSError as problem:
                raise web.Unfetched(f"{where}: {problem.strerror}") from problem
        else:
            data = self.kept(where)
        try:
            return lists.decoded(data)
        except ValueError as problem:
            raise web.Unfetched(f"{where}: no JSON ({problem})") from problem

    def kept(self, url: str) -> bytes:
        """Read a document that was brought before, or bring it."""
        name = f"{DOCUMENTS}/{hashlib.sha256(url.encode()).hexdigest()[:40]}.json"
        if self.store.exists(name):
            return self.store.read_bytes(name, DOCUMENT_BYTES)
        data = self.fetch(url, DOCUMENT_BYTES)
        if not data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith((b"{", b"[")):
            raise web.Unfetched(f"{url}: no JSON: name a IIIF manifest")
        self.store.write_bytes(name, data)
        return data

    def fetch(self, url: str, most: int) -> bytes:
        """Bring something, unless the server is given up."""
        asked = self.asked if web.is_web(self.asked) else url
        return web.fetch(url, most, asked=asked, patience=self.patience)


def brought(
    source: str,
    city: str,
    *,
    tell: lists.Tell = lists.silent,
    patience: web.Patience | None = None,
) -> tuple[Path, lists.Listing]:
    """Bring all photographs of a source; give their folder, and a row for each.

    Raises:
        Nothing: if the source can't be read, or gives no photograph.
    """
    if "://" in city:
        raise Nothing(f"{city} is not on this machine: bring {source} to one that is")
    at = Source(source, Store(city), patience or web.Patience())
    rows, rejections = [], []
    for one in photographs(at):
        made = one if isinstance(one, Rejection) else picture(at, *one)
        if isinstance(made, Rejection):
            rejections.append(made)
        else:
            rows.append(made)
            if len(rows) % 20 == 0:
                tell("fetched", f"{len(rows)} photographs are here", done=len(rows))
        if at.failed >= GIVE_UP:
            why = f"it failed for {GIVE_UP} photographs in a row; index again later"
            rejections.append(Rejection(source, "fetch", "server given up", why))
            break
    if not rows:
        first = rejections[0] if rejections else None
        why = f": {first.key}: {first.reason}: {first.detail}" if first else ""
        raise Nothing(f"{source} gives no photograph{why}")
    listing = lists.Listing(short(source), rows, tuple(rejections), lists.FIRST_RECORD)
    return Path(city) / PHOTOGRAPHS, listing


def listing(source: str, city: str) -> lists.Listing:
    """Read what a source tells of its photographs, and bring none of them.

    Raises:
        Nothing: if it can't be read.
    """
    rows, rejections = [], []
    for one in photographs(Source(source, Store(city))):
        if isinstance(one, Rejection):
            rejections.append(one)
        else:
            rows.append(one[0] | {"photo": one[2]})
    if not rows:
        why = f": {rejections[0].detail}" if rejections else ""
        raise Nothing(f"{source} lists no photograph{why}")
    name, first = short(source), lists.FIRST_RECORD
    return lists.Listing(name, rows, tuple(rejections), first)


def photographs(
    at: Source,
) -> Iterator[tuple[dict[str, str], iiif.Resource, str] | Rejection]:
    """List the photographs of a source: what is told, where it lies, its file's name.

    A collection is followed through its manifests, each once.
    """
    waiting, seen, names = [at.asked], {at.asked}, set[str]()
    while waiting:
        where = waiting.pop(0)
        try:
            found = iiif.Document.model_validate(at.document(where))
            if found.collects:
                fresh = [one for one in found.others() if one not in seen]
                waiting += fresh[: MOST_DOCUMENTS - len(seen)]
                seen.update(waiting)
                continue
            for number, canvas in enumerate(found.canvases(), 1):
                shown = iiif.picture(canvas)
                if shown is None:
                    key = f"{short(where)} photograph {number}"
                    why = "nothing is painted on its canvas"
                    yield Rejection(key, "fetch", "no picture", why)
                elif len(names) < MOST_PHOTOGRAPHS:
                    cells = iiif.cells(canvas, found)
                    yield cells, shown, called(cells, canvas, found, names)
        except ValidationError as problem:
            yield Rejection(short(where), "fetch", "no IIIF manifest", told(problem))
        except (web.Unfetched, OSError) as problem:
            yield Rejection(short(where), "fetch", "no manifest", str(problem))


def picture(
    at: Source, cells: dict[str, str], shown: iiif.Resource, name: str
) -> dict[str, str] | Rejection:
    """Bring one photograph, unless it is here; give its row."""
    for suffix in dict.fromkeys(PICTURES.values()):
        if at.store.exists(f"{PHOTOGRAPHS}/{name}{suffix}"):
            at.failed = 0
            return cells | {"photo": f"{name}{suffix}"}
    try:
        data = at.fetch(best(at, shown), bounded.PHOTO_BYTES)
        suffix = of_picture(data, shown.id or "")
    except web.Unfetched as problem:
        at.failed += 1
        return Rejection(name, "fetch", "not brought", f"{problem}; index again later")
    at.failed = 0
    at.store.write_bytes(f"{PHOTOGRAPHS}/{name}{suffix}", data)
    return cells | {"photo": f"{name}{suffix}"}


def of_picture(data: bytes, where: str) -> str:
    """Tell a picture's suffix by what it begins with, whatever a server calls it.

    Raises:
        Unfetched: if it is none.
    """
    for start, suffix in PICTURES.items():
        if data.startswith(start):
            return suffix
    raise web.Unfetched(f"{where}: no picture, or of no kind that is known")


def best(at: Source, shown: iiif.Resource) -> str:
    """Choose the address of a photograph in the size that is of use."""
    service = iiif.image_service(shown)
    if service is None or service.id is None:
        return shown.id or ""
    try:
        told = at.document(f"{service.id.rstrip('/')}/info.json")
        return iiif.request(service.id, iiif.Info.model_validate(told))
    except (web.Unfetched, ValidationError):
        return shown.id or ""


def called(
    cells: dict[str, str], canvas: iiif.Canvas, of: iiif.Document, taken: set[str]
) -> str:
    """Name a photograph's file by its label; the same label twice gets a mark."""
    label = iiif.words(canvas.label)
    if not re.search(r"\d", label) or len(label) < 3:  # "recto", "1": of what?
        label = " ".join(filter(None, (iiif.words(of.label), label)))
    name = LOSSLESS_NAMES.sub("_", label)[:LONGEST].strip("._ ") or "photograph"
    mark = hashlib.sha256((canvas.id or str(cells)).encode()).hexdigest()[:8]
    if name.casefold() in taken:
        name = f"{name}.{mark}"
    taken.add(name.casefold())
    return name


def short(source: str) -> str:
    """Name a source in messages: by its last words."""
    parts = [one for one in re.split(r"[/\\]", source) if one]
    return "/".join(parts[-2:] if web.is_web(source) else parts[-1:])[:LONGEST]
