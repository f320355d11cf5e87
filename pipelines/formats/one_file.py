"""Formats that tell a whole city in one file, written block by block.

Of a city no more is held than one block, and the names of its photographs.
"""

import contextlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from PIL import Image

from nostalgin_core import formats
from nostalgin_core.formats import Canvas, Shown
from pipelines.formats.published import Json, Published, Unexportable
from pipelines.formats.words import attributes
from pipelines.site import Folder, safe

MIMES: Final = {".webp": "image/webp", ".jpg": "image/jpeg", ".png": "image/png"}
RIGHTS: Final = ("creativecommons.org/", "rightsstatements.org/")


def text(value: Json) -> bytes:
    """Write a value on one line."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False).encode()


def single(target: Path, name: str, value: Json) -> int:
    """Write a format that is one file."""
    folder = Folder(target, [name])
    folder.write(name, text(value))
    folder.prune()
    return 1


class GeoJson:
    """One collection of all footprints, which grows block by block."""

    name = "geojson"
    file: Final = "footprints.geojson"

    def __init__(
        self, folder: Path, site: Published, ending: contextlib.ExitStack
    ) -> None:
        """Take the folder for the one file, dropped if all ends by an error."""
        self._site, self._folder = site, Folder(folder, [self.file])
        self._growing = ending.enter_context(contextlib.ExitStack())
        self._out = self._growing.enter_context(self._folder.growing(self.file))
        self._out.write(b'{"type": "FeatureCollection", "features": [\n')
        self._between = b""

    def add(self, block: Json, shown: Shown, buildings: list[Json]) -> None:
        """Write one block's footprints."""
        ground = self._site.ground(block)
        known = {str(one["id"]): one for one in buildings}
        for shell in shown.shells:
            facts = attributes(shown, shell, known.get(shell.name, {}))
            made = formats.footprint(shell, ground, attributes=facts)
            if made is not None:
                self._out.write(self._between + text(made))
                self._between = b",\n"

    def close(self) -> int:
        """End the collection, and put it in its place."""
        self._out.write(b"\n]}\n")
        self._growing.close()
        self._folder.prune()
        return 1


class Iiif:
    """One manifest of all photographs that the site has pictures of."""

    file: Final = "manifest.json"

    def __init__(self, folder: Path, site: Published) -> None:
        """Take the folder for the one file."""
        self._folder, self._site = folder, site

    def write(self, base: str) -> int:
        """Write the manifest block by block.

        Raises:
            Unexportable: if there is no photograph, for a manifest needs one.
        """
        canvases = (text(formats.canvas(base, one)) for one in self._each())
        first = next(canvases, None)
        if first is None:
            raise Unexportable("IIIF shows photographs, and this city has none to show")
        head = text(formats.presentation(base, title=self._site.title))
        begin, end = head[: -len(b"]}")], b"]}"
        folder = Folder(self._folder, [self.file])
        with folder.growing(self.file) as out:
            out.write(begin + first)
            out.writelines(b", " + one for one in canvases)
            out.write(end)
        folder.prune()
        return 1

    def _each(self) -> Iterator[Canvas]:
        """List each photograph once, as the first block tells of it."""
        seen: set[str] = set()
        for block in self._site.blocks:
            for one in pictures(self._site, block):
                if one.name not in seen:
                    seen.add(one.name)
                    yield one


def pictures(site: Published, block: Json) -> list[Canvas]:
    """List the photographs of a block that the site has pictures of."""
    made = []
    for building in site.buildings(block):
        for photo in building.get("photos", ()):
            file = photo.get("file")
            if not file or Path(file).suffix not in MIMES:
                continue
            try:
                with Image.open(site.file(file)) as picture:
                    width, height = picture.size
            except OSError as problem:
                raise Unexportable(f"{file}: {problem}; build again") from problem
            rights = str(photo.get("rights", ""))
            made.append(
                Canvas(
                    name=safe(str(photo["key"])),
                    label=str(photo.get("caption") or photo["key"]),
                    file=file,
                    mime=MIMES[Path(file).suffix],
                    width_px=width,
                    height_px=height,
                    credit=str(photo.get("credit", "")),
                    rights=rights if any(one in rights for one in RIGHTS) else "",
                    source=str(photo.get("source_url", "")),
                    known={
                        "Block": str(block["name"]),
                        "Lot": str(building.get("lot", "")),
                        "Address": str(building.get("address", "")),
                    },
                )
            )
    return made
