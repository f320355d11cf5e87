"""The site: a static folder that any web server turns into a walkable city.

    index.html, assets/            the viewer, built from `viewer/`
    blocks/<block>-<sha8>.glb      models, named by content
    far/<block>-<sha8>.glb         the same with fewer texels, and volumes of districts
    photos/<key>.webp              thumbnails of the photographs
    tileset-<sha8>.json            3D Tiles, as site.json names them
    tiles-<sha16>.json             its districts, where there are many
    site.json                      what is known of blocks and buildings
    tileset.json                   the same 3D Tiles, under the name that others know

What others name is named by its content and comes first, and stays until the city after
the next; site.json and tileset.json come last, each in one move. So a reader meets the
one city or the other, never half of both. Nothing is removed that we did not write
(`folder`).
"""

import dataclasses
import hashlib
import io
import json
import re
from collections.abc import Callable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np
from PIL import Image

from nostalgin_core import city
from nostalgin_core.arrays import Gray
from nostalgin_core.model import legend
from pipelines.site.folder import RECORD, Folder, recorded

VIEWER: Final = Path(__file__).with_name("viewer_dist")
THUMBNAIL_PX: Final = 1600  # a screen's height, for the view from where it was taken
NAMELESS: Final = "other"  # what has no harmless letters, as a street in Kyoto
SUFFIXES: Final = ((b"\xff\xd8\xff", ".jpg"), (b"\x89PNG\r\n\x1a\n", ".png"))

SWAPPED: Final = ("site.json", "tileset.json")  # last, in this order

Json = dict[str, Any]
Data = bytes | Callable[[], bytes]  # or how to read it, one block at a time


class ViewerMissingError(FileNotFoundError):
    """The viewer was not built, with the command that builds it."""

    def __init__(self) -> None:
        """Name the remedy."""
        super().__init__(f"no viewer at {VIEWER}; build it with `make viewer`")


@dataclass(frozen=True)
class BlockModel:
    """One block's model, what is known of it, and where it lies.

    `record` is what `record.record` writes: `block`, `outline_m` and `buildings`,
    whose `photos` name keys of the photographs. It may carry more, which is kept.
    """

    name: str
    glb: Data
    record: Mapping[str, Any]
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
    files = {key: _pictured(key, photos, standing) for key in photos}
    tiles = [_tile(*each) for each in zip(models, blocks, coarse, strict=True)]
    tree = city.tree(tiles, place=place)
    tileset = _text(tree.tileset)
    named = f"tileset-{hashlib.sha256(tileset).hexdigest()[:8]}.json"
    each = zip(models, blocks, coarse, tree.frames, strict=True)
    record = _record(title, named, place, [_block(*one, files) for one in each])
    far = zip(coarse, blocks, strict=True)
    pages = {
        "index.html": index.read_bytes(),
        named: tileset,
        **dict(zip(SWAPPED, (_text(record), tileset), strict=True)),
    }
    named_files = {
        **_assets(viewer),
        **{name: partial(photos.__getitem__, key) for key, name in files.items()},
        **{uri: one.glb for uri, one in zip(models, blocks, strict=True)},
        **{uri: one.coarse for uri, one in far if one.coarse is not None},
        **tree.files,
        **pages,
    }
    _written(destination, named_files, standing & {*models, *coarse, *files.values()})


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


def _written(
    destination: Path,
    files: Mapping[str, Data],
    standing: AbstractSet[str] = frozenset(),
) -> None:
    """Write files in their order, one at a time, and remove what is named no more.

    Those that are `standing` are what they are to be.
    """
    site = Folder(destination, list(files))
    for name, data in files.items():
        if name not in standing:
            site.write(name, content(data))
    site.prune()


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


def _pictured(key: str, photos: Mapping[str, bytes], standing: AbstractSet[str]) -> str:
    """Name a photo's small picture: as it stands there, else by its first bytes."""
    stem = f"photos/{safe(key)}"
    known = (stem + end for end in (".webp", *(end for _, end in SUFFIXES)))
    there = next((name for name in known if name in standing), None)
    return there or stem + suffix(photos[key])


def digest(data: Data, sha256: str = "") -> str:
    """Give a model's file name what changes with its content."""
    return (sha256 or hashlib.sha256(content(data)).hexdigest())[:8]


def content(data: Data) -> bytes:
    """Give a model, which may have to be read first."""
    return data() if callable(data) else data


def safe(name: str) -> str:
    """Turn any name into a file name; different names give different ones.

    A harmless name stays as it is; another keeps its harmless letters and gets its
    hash. None begins with a dot or a line, which hosts of sites leave out.
    """
    if re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}", name):
        return name
    letters = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-_")[:40] or NAMELESS
    # a dot is in no harmless name, so that no other name can pose as this one
    return f"{letters}.{hashlib.sha256(name.encode()).hexdigest()[:12]}"


def suffix(data: bytes) -> str:
    """Tell a picture's file suffix by its first bytes."""
    if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
        return ".webp"
    return next((end for start, end in SUFFIXES if data.startswith(start)), ".bin")


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


def _record(title: str, tileset: str, place: city.Place | None, blocks: list) -> Json:
    told = {} if place is None else {"place": dataclasses.asdict(place)}
    named = {"title": title, "tileset": tileset, "legend": legend()}
    return {**named, **told, "blocks": blocks}


def _block(
    uri: str, block: BlockModel, far: str, frame: Any, files: Mapping[str, str]
) -> Json:
    buildings = [
        {**building, "photos": [_photo(one, files) for one in building["photos"]]}
        for building in block.record["buildings"]
    ]
    told = {"name": block.name, "uri": uri, "buildings": buildings}
    return {**block.record, **told, "coarse": far, "frame": frame}


def _photo(photo: Mapping[str, Any], files: Mapping[str, str]) -> Json:
    return {**photo, "file": files.get(photo["key"])}


def _text(value: Json) -> bytes:
    return json.dumps(value, ensure_ascii=False, allow_nan=False).encode()
