"""One published city, written in the formats that are asked for.

    OUT/cityjson/<block>.city.jsonl, textures/<block>.png, textures/<block>-evidence.png
    OUT/obj/<block>.zip
    OUT/geojson/footprints.geojson
    OUT/prov/provenance.json
    OUT/iiif/manifest.json

Each format has a folder of its own with a record of what we wrote there, as a site has,
and nothing of another's is touched. Models are read, and all but the provenance is
written, block by block.
"""

import contextlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from nostalgin_core import formats
from nostalgin_core.formats import Shown
from pipelines.formats import provenance
from pipelines.formats.one_file import GeoJson, Iiif, single, text
from pipelines.formats.published import Json, Published, Unexportable, published
from pipelines.formats.words import attributes
from pipelines.site import Folder, safe

FORMATS: Final = ("cityjson", "obj", "geojson", "prov", "iiif")

Tell = Callable[[str, int], None]  # a block's name, and how many are done


@dataclass(frozen=True)
class Exported:
    """What was written, and what this city can't be told in."""

    files: Mapping[str, int]  # of each format
    refused: Mapping[str, str]  # why, and what to do about it, by format


def silent(block: str, done: int) -> None:
    """Tell nobody."""


def export(
    city: Path, out: Path, wanted: Sequence[str], *, base: str = "", tell: Tell = silent
) -> Exported:
    """Write a city; tell how many files each format has, and which ones it can't have.

    `base` is the address where its site will lie: IIIF names everything by address.

    Raises:
        Unexportable: if there is no site, none of the formats can tell it, or what is
            asked for makes no sense; nothing is written then.
        Foreign: if a folder or a file in the way is another's.
    """
    site = published(city)
    base = checked(wanted, base)
    refused = unfit(site, wanted)
    wanted = [one for one in wanted if one not in refused]
    if not wanted:
        raise Unexportable("; ".join(refused.values()))
    told = provenance.read(city, site) if "prov" in wanted else None
    counts: dict[str, int] = {}
    with contextlib.ExitStack() as ending:
        makers: list[Any] = []
        if "cityjson" in wanted:
            makers.append(CityJson(out / "cityjson", site))
        if "obj" in wanted:
            makers.append(Obj(out / "obj", site))
        if "geojson" in wanted:
            makers.append(GeoJson(out / "geojson", site, ending))
        for done, block in enumerate(site.blocks if makers else [], 1):
            shown, buildings = site.shown(block), site.buildings(block)
            for maker in makers:
                maker.add(block, shown, buildings)
            tell(str(block["name"]), done)
        counts |= {maker.name: maker.close() for maker in makers}
    if told is not None:
        counts["prov"] = single(out / "prov", "provenance.json", told)
    if "iiif" in wanted:
        counts["iiif"] = Iiif(out / "iiif", site).write(base)
    return Exported(counts, refused)


def unfit(site: Published, wanted: Sequence[str]) -> dict[str, str]:
    """Tell which formats this city can't be told in, and what to do about it."""
    if "geojson" not in wanted or site.place is not None:
        return {}
    words = (
        "GeoJSON knows degrees alone (RFC 7946), and this city has no place on the "
        "globe: give it one (`nostalgin index --place LAT,LON,BEARING`) and build again"
    )
    return {"geojson": words}


def checked(wanted: Sequence[str], base: str) -> str:
    """Insist that what is asked for makes sense, before anything is written."""
    odd = next((one for one in wanted if one not in FORMATS), None)
    if odd is not None or not wanted:
        raise Unexportable(f"--to {odd or ''}: choose of {', '.join(FORMATS)}")
    if "iiif" in wanted and not base.startswith(("https://", "http://")):
        raise Unexportable(
            "IIIF names everything by its address: tell with --base https://... where "
            "the site will lie"
        )
    return base if base.endswith("/") else f"{base}/"


class CityJson:
    """A CityJSON sequence a block, and its textures."""

    name = "cityjson"

    def __init__(self, folder: Path, site: Published) -> None:
        """Take the folder for all files."""
        self._site = site
        names = [name for one in site.blocks for name in self._names(one)]
        self._folder, self._count = Folder(folder, names), len(names)

    def add(self, block: Json, shown: Shown, buildings: list[Json]) -> None:
        """Write one block."""
        file, *images = self._names(block)
        ground = self._site.ground(block)
        known = {str(one["id"]): one for one in buildings}
        lines = [formats.header(ground, title=f"{self._site.title} {shown.block}")]
        lines += [
            formats.feature(
                shell,
                ground,
                attributes=attributes(shown, shell, known.get(shell.name, {})),
                images=images,
            )
            for shell in shown.shells
        ]
        if shown.ground is not None:
            lines.append(formats.land(shown.ground, ground, images=images))
        self._folder.write(images[0], formats.png(shown.colours))
        self._folder.write(images[1], formats.png(formats.tinted(shown.evidence)))
        self._folder.write(file, b"".join(text(line) + b"\n" for line in lines))

    def close(self) -> int:
        """End, and count the files."""
        self._folder.prune()
        return self._count

    def _names(self, block: Json) -> list[str]:
        name = safe(str(block["name"]))
        images = [f"textures/{name}.png", f"textures/{name}-evidence.png"]
        return [f"{name}.city.jsonl", *images]


class Obj:
    """A zip a block."""

    name = "obj"

    def __init__(self, folder: Path, site: Published) -> None:
        """Take the folder for all files."""
        self._site = site
        names = [self._name(one) for one in site.blocks]
        self._folder, self._count = Folder(folder, names), len(names)

    def add(self, block: Json, shown: Shown, buildings: list[Json]) -> None:
        """Write one block."""
        told = {
            "block": shown.block,
            "frame": block["frame"],
            "place": self._site.record.get("place"),
            "scale": 1.0,
            "copyright": shown.copyright,
            **{key: shown.extras.get(key) for key in ("credit", "licence", "sources")},
            "buildings": [one["id"] for one in buildings],
        }
        name = self._name(block)
        data = formats.archive(shown, name.removesuffix(".zip"), told=told)
        self._folder.write(name, data)

    def close(self) -> int:
        """End, and count the files."""
        self._folder.prune()
        return self._count

    def _name(self, block: Json) -> str:
        return f"{safe(str(block['name']))}.zip"
