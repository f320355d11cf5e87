"""The city that is shown: its record, its models and where its blocks lie."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from nostalgin_core import city, formats
from pipelines import bounded
from pipelines.site import altered, inside

SITE: Final = "site"
EARLIER: Final = "it was written by an earlier version, all buildings in one file"

Json = dict[str, Any]


class Unexportable(ValueError):  # noqa: N818 - it reads as what it is about
    """A city that can't be written as is asked, with what to do about it."""


@dataclass(frozen=True)
class Published:
    """A site of ours, read file by file."""

    folder: Path
    record: Json

    @property
    def title(self) -> str:
        """Give the city's name."""
        return str(self.record.get("title", ""))

    @property
    def place(self) -> city.Place | None:
        """Tell where on the globe it lies, if it is known."""
        told = self.record.get("place")
        return None if told is None else city.Place(**told)

    @property
    def blocks(self) -> list[Json]:
        """List the headers of its blocks."""
        return self.record["blocks"]

    def buildings(self, block: Json) -> list[Json]:
        """Read what is known of a block's buildings.

        Raises:
            Unexportable: if its record is gone, or is not the one that was written.
        """
        path = self.file(block["record"])
        try:
            data = bounded.read(path, bounded.TABLE_BYTES)
        except OSError as problem:
            why = problem.strerror
            raise Unexportable(f"{path}: {why}; build the city again") from problem
        if altered(block["record"], data):
            raise Unexportable(f"{path} is damaged; build the city again")
        return json.loads(data)["buildings"]

    def file(self, name: str) -> Path:
        """Find a file that the record names, inside the site.

        Raises:
            Unexportable: if the name leads out of it.
        """
        path = self.folder / name
        if not inside(name) or not path.resolve().is_relative_to(self.folder.resolve()):
            raise Unexportable(f"{self.folder}: {name!r} lies elsewhere: build again")
        return path

    def glb(self, block: Json) -> bytes:
        """Read a block's model."""
        path = self.file(block["uri"])
        try:
            return bounded.read(path, bounded.PHOTO_BYTES)
        except OSError as problem:
            why = problem.strerror
            raise Unexportable(f"{path}: {why}; build the city again") from problem

    def shown(self, block: Json) -> formats.Shown:
        """Read a block's model, and what it shows."""
        try:
            return formats.read(self.glb(block))
        except formats.Unreadable as problem:
            where = self.folder / block["uri"]
            raise Unexportable(f"{where}: {problem}; build the city again") from problem

    def ground(self, block: Json) -> formats.Ground:
        """Tell where a block lies."""
        if self.place is None:
            return formats.of_plane(block["frame"])
        return formats.of_globe(block["frame"], self.place)


def published(folder: Path) -> Published:
    """Read the site of a city.

    Raises:
        Unexportable: if there is none, or it was written by an older version.
    """
    for site in (folder / SITE, folder):
        path = site / "site.json"
        if path.is_file():
            break
    else:
        raise Unexportable(f"{folder} holds no site: run `nostalgin build {folder}`")
    try:
        record = json.loads(bounded.read(path, bounded.TABLE_BYTES))
        frames = [(one["frame"], one["uri"], one["record"]) for one in record["blocks"]]
    except (OSError, ValueError, LookupError, TypeError, RecursionError) as problem:
        why = EARLIER if isinstance(problem, KeyError) else str(problem)
        words = f"{path}: {why}: `nostalgin build {folder}` writes it anew"
        raise Unexportable(words) from problem
    if not frames:
        raise Unexportable(f"{path} shows no block")
    return Published(site, record)
