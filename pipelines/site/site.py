"""The site: a static folder that any web server turns into a walkable city.

    index.html, assets/            the viewer, built from `viewer/`
    blocks/<block>-<sha8>.glb      models, named by content
    far/<block>-<sha8>.glb         the same with fewer texels, and volumes of districts
    photos/<key>.webp              thumbnails of the photographs
    records/<block>-<sha8>.json    what is known of a block's buildings (`parts`)
    finder/<number>-<sha8>.json    buildings to search in
    tileset-<sha8>.json            3D Tiles, as site.json names them
    tiles-<sha16>.json             its districts, where there are many
    site.json                      a header a block, which names its record and models
    tileset.json                   the same 3D Tiles, under the name that others know

What others name is named by its content and comes first, and stays until the city after
the next; site.json and tileset.json come last, each in one move. So a reader meets the
one city or the other, never half of both. Nothing is removed that we did not write
(`folder`).
"""

import dataclasses
import hashlib
import io
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any, Final

import numpy as np
from PIL import Image

from nostalgin_core import city
from nostalgin_core.arrays import Gray
from nostalgin_core.model import legend
from pipelines.site.aside import Aside
from pipelines.site.folder import RECORD, Folder, recorded
from pipelines.site.naming import SUFFIXES, Data, content, digest, safe, suffix
from pipelines.site.parts import Parts, text

VIEWER: Final = Path(__file__).with_name("viewer_dist")
THUMBNAIL_PX: Final = 1600  # a screen's height, for the view from where it was taken

CENTIMETRE: Final = 2  # digits
SWAPPED: Final = ("site.json", "tileset.json")  # last, in this order

Json = dict[str, Any]
Record = Mapping[str, Any]


class ViewerMissingError(FileNotFoundError):
    """The viewer was not built, with the command that builds it."""

    def __init__(self) -> None:
        """Name the remedy."""
        super().__init__(f"no viewer at {VIEWER}; build it with `make viewer`")


@dataclass(frozen=True)
class BlockModel:
    """One block's model, what is known of it, and where it lies.

    `record` is what `record.record` writes, or how to read it: `block`, `outline_m` and
    `buildings`, whose `photos` name keys of the photographs. What it carries beside the
    buildings is told by site.json for all blocks at once.
    """

    name: str
    glb: Data
    record: Record | Callable[[], Record]
    low_m: tuple[float, float, float]  # the model's bounds: east, north, up
    high_m: tuple[float, float, float]
    origin_m: tuple[float, float] = (0.0, 0.0)  # east, north of the city's origin
    place: city.Place | None = None  # in place of origin_m, where it is known
    turn_rad: float = 0.0  # of its frame against east, anticlockwise
    coarse: Data | None = None  # the same with fewer texels
    coarse_texel_m: float = 0.0  # the largest of these
    footprints_m: np.ndarray | None = None  # n 4 2, of its buildings in its own frame
    heights_m: np.ndarray | None = None
    sha256: str = ""  # of `glb`, where it is known without reading it
    coarse_sha256: str = ""


def assemble(
    destination: Path,
    *,
    blocks: Sequence[BlockModel],
    photos: Mapping[str, bytes],
    title: str,
    place: city.Place | None = None,
    viewer: Path = VIEWER,
    trusting: bool = False,
) -> None:
    """Write the site of a city; nothing outside `destination` is touched.

    `trusting` leaves the models and pictures that stand there as they are, unopened.
    `photos` are encoded thumbnails (WebP, JPEG or PNG) by key. A building's photo whose
    key is not among them gets no `file`, and the viewer says so. Names of blocks and
    photos may be anything: file names are made from their harmless letters, and from
    their hash where two would clash.

    Raises:
        ViewerMissingError: if the viewer was not built.
        Foreign: if `destination` or a file in the way is not our own.
        ValueError: if there is no block, or two have the same name.
    """
    index = _sound(blocks, viewer)
    standing = stands(destination) if trusting else frozenset[str]()
    models, coarse = zip(
        *(_named(one, trusting=trusting) for one in blocks), strict=True
    )
    files = Pictures(photos, standing)
    tiles = [_tile(*each) for each in zip(models, blocks, coarse, strict=True)]
    tree = city.tree(tiles, place=place)
    tileset = text(tree.tileset)
    named = f"tileset-{hashlib.sha256(tileset).hexdigest()[:8]}.json"
    with Aside(destination.parent) as aside:
        parts = Parts(aside)
        each = zip(blocks, models, coarse, tree.frames, strict=True)
        for one, uri, far, frame in each:
            parts.add(_told(one, files), _header(one, uri, far, frame))
        last = (text(_city(title, named, place) | parts.close()), tileset)
        made = {
            **_assets(viewer),
            **dict(_models(zip(models, coarse, blocks, strict=True))),
            **tree.files,
            **parts.files,
            "index.html": index.read_bytes(),
            named: tileset,
            **dict(zip(SWAPPED, last, strict=True)),
        }
        _written(destination, files, made, standing - {*parts.files, *tree.files})


def _written(
    destination: Path,
    pictures: "Pictures",
    files: Mapping[str, Data],
    standing: AbstractSet[str],
) -> None:
    """Write files in their order, one at a time, and remove what is named no more.

    Models and pictures that are `standing` are what they are to be.
    """
    site = Folder(destination, chain((name for _, name in pictures.each()), files))
    for key, name in pictures.each():
        if name not in standing:
            site.write(name, pictures.photos[key])
    for name, data in files.items():
        if name not in standing or not name.startswith(("blocks/", "far/")):
            site.write(name, content(data))
    site.prune()


class Pictures:
    """The files of photographs, by their keys; what follows from a key is not held."""

    def __init__(self, photos: Mapping[str, bytes], standing: AbstractSet[str]) -> None:
        """Look at the first bytes of those that are not `standing`."""
        self.photos = photos
        named = ((key, _pictured(key, photos, standing)) for key in photos)
        self._others = {k: name for k, name in named if name != _webp(k)}

    def file(self, key: str) -> str | None:
        """Name the file of a photo; None if there is none."""
        return self._others.get(key, _webp(key)) if key in self.photos else None

    def each(self) -> Iterator[tuple[str, str]]:
        """Give all keys, and their files' names."""
        return ((key, self._others.get(key, _webp(key))) for key in self.photos)


def _city(title: str, tileset: str, place: city.Place | None) -> Json:
    """Tell what is known of the city alone."""
    told = {"title": title, "tileset": tileset, "legend": legend()}
    return told if place is None else {**told, "place": dataclasses.asdict(place)}


def _models(named: Iterable[tuple[str, str, BlockModel]]) -> Iterator[tuple[str, Data]]:
    """Name the models' files, and how to read them."""
    for fine, coarse, one in named:
        yield fine, one.glb
        if one.coarse is not None:
            yield coarse, one.coarse


def _sound(blocks: Sequence[BlockModel], viewer: Path) -> Path:
    """Insist on blocks of different names, and on a viewer; give its page."""
    names = [block.name for block in blocks]
    if len(set(names)) != len(names):
        raise ValueError(f"blocks must have names of their own: {sorted(names)}")
    index = viewer / "index.html"
    if not index.is_file():
        raise ViewerMissingError
    return index


def _assets(viewer: Path) -> dict[str, Data]:
    """Name the viewer's files, and how to read them."""
    paths = sorted((viewer / "assets").iterdir())
    return {f"assets/{path.name}": path.read_bytes for path in paths}


def thumbnail(image: Gray, *, longest_px: int = THUMBNAIL_PX) -> bytes:
    """Encode a photograph as a small WebP, never larger than it was."""
    picture = Image.fromarray(image)
    picture.thumbnail((longest_px, longest_px), Image.Resampling.LANCZOS)
    file = io.BytesIO()
    picture.save(file, "WEBP", quality=80, method=4)
    return file.getvalue()


def stands(destination: Path) -> frozenset[str]:
    """List the files of the city that is shown, as far as they are there."""
    if not (destination / RECORD).exists():
        return frozenset()
    paths = {name: destination / name for name in recorded(destination)[0]}
    return frozenset(
        n for n, at in paths.items() if at.is_file() and not at.is_symlink()
    )


def _named(one: BlockModel, *, trusting: bool) -> tuple[str, str]:
    """Name the files of a block's model and of its coarse one; "" if it has none."""
    fine = digest(one.glb, one.sha256 if trusting else "")
    model = f"blocks/{safe(one.name)}-{fine}.glb"
    if one.coarse is None:
        return model, ""
    coarse = digest(one.coarse, one.coarse_sha256 if trusting else "")
    return model, f"far/{safe(one.name)}-{coarse}.glb"


def _webp(key: str) -> str:
    return f"photos/{safe(key)}.webp"


def _pictured(key: str, photos: Mapping[str, bytes], standing: AbstractSet[str]) -> str:
    """Name a photo's small picture: as it stands there, else by its first bytes."""
    stem = f"photos/{safe(key)}"
    known = (stem + end for end in (".webp", *(end for _, end in SUFFIXES)))
    there = next((name for name in known if name in standing), None)
    return there or stem + suffix(photos[key])


def _tile(uri: str, one: BlockModel, coarse: str) -> city.Tile:
    return city.Tile(
        uri,
        one.low_m,
        one.high_m,
        one.origin_m,
        one.place,
        one.turn_rad,
        coarse,
        one.coarse_texel_m,
        one.footprints_m,
        one.heights_m,
    )


def _header(one: BlockModel, uri: str, far: str, frame: Any) -> Json:
    top_m = round(float(one.high_m[2]), CENTIMETRE)
    return {"name": one.name, "uri": uri, "coarse": far, "frame": frame, "top_m": top_m}


def _told(block: BlockModel, files: Pictures) -> Json:
    """Give a block's record, whose photos name their small pictures."""
    record = block.record() if callable(block.record) else block.record
    buildings = [
        {
            **building,
            "photos": [
                {**one, "file": files.file(one["key"])} for one in building["photos"]
            ],
        }
        for building in record["buildings"]
    ]
    return {**record, "buildings": buildings}
