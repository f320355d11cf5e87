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
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from PIL import Image

from nostalgin_core import city
from nostalgin_core.arrays import Gray
from nostalgin_core.model import legend
from pipelines.site.folder import Folder

VIEWER: Final = Path(__file__).with_name("viewer_dist")
THUMBNAIL_PX: Final = 1600  # a screen's height, for the view from where it was taken
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


def assemble(
    destination: Path,
    *,
    blocks: Sequence[BlockModel],
    photos: Mapping[str, bytes],
    title: str,
    place: city.Place | None = None,
    viewer: Path = VIEWER,
) -> None:
    """Write the site of a city; nothing outside `destination` is touched.

    `photos` are encoded thumbnails (WebP, JPEG or PNG) by key. A building's photo whose
    key is not among them gets no `file`, and the viewer says so. Names of blocks and
    photos may be anything: file names are made from their harmless letters, and from
    their hash where two would clash.

    Raises:
        ViewerMissingError: if the viewer was not built.
        Foreign: if `destination` or a file in the way is not our own.
        ValueError: if there is no block, or two have the same name.
    """
    names = [block.name for block in blocks]
    if len(set(names)) != len(names):
        raise ValueError(f"blocks must have names of their own: {sorted(names)}")
    index = viewer / "index.html"
    if not index.is_file():
        raise ViewerMissingError
    models = {f"blocks/{safe(one.name)}-{digest(one.glb)}.glb": one for one in blocks}
    coarse = [
        "" if one.coarse is None else f"far/{safe(one.name)}-{digest(one.coarse)}.glb"
        for one in blocks
    ]
    files = {key: f"photos/{safe(key)}{suffix(data)}" for key, data in photos.items()}
    tiles = [
        _tile(uri, one, far)
        for (uri, one), far in zip(models.items(), coarse, strict=True)
    ]
    tree = city.tree(tiles, place=place)
    tileset = _text(tree.tileset)
    named = f"tileset-{hashlib.sha256(tileset).hexdigest()[:8]}.json"
    record = {
        "title": title,
        "tileset": named,
        "legend": legend(),
        **({"place": dataclasses.asdict(place)} if place is not None else {}),
        "blocks": [
            {**_block(uri, one, files), "coarse": far, "frame": frame}
            for (uri, one), far, frame in zip(
                models.items(), coarse, tree.frames, strict=True
            )
        ],
    }
    assets = {f"assets/{p.name}": p for p in sorted((viewer / "assets").iterdir())}
    far = {
        uri: one.coarse
        for uri, one in zip(coarse, blocks, strict=True)
        if one.coarse is not None
    }
    names = [*assets, *files.values(), *models, *far, *tree.files]
    site = Folder(destination, [*names, "index.html", named, *SWAPPED])
    for name, path in assets.items():
        site.write(name, path.read_bytes())
    for key, data in photos.items():
        site.write(files[key], data)
    for uri, one in models.items():
        site.write(uri, content(one.glb))
    for uri, data in (far | tree.files).items():
        site.write(uri, content(data))
    pages = (index.read_bytes(), tileset, _text(record), tileset)
    for name, data in zip(("index.html", named, *SWAPPED), pages, strict=True):
        site.write(name, data)
    site.prune()


def thumbnail(image: Gray, *, longest_px: int = THUMBNAIL_PX) -> bytes:
    """Encode a photograph as a small WebP, never larger than it was."""
    picture = Image.fromarray(image)
    picture.thumbnail((longest_px, longest_px), Image.Resampling.LANCZOS)
    file = io.BytesIO()
    picture.save(file, "WEBP", quality=80, method=4)
    return file.getvalue()


def digest(data: Data) -> str:
    """Give a model's file name what changes with its content."""
    return hashlib.sha256(content(data)).hexdigest()[:8]


def content(data: Data) -> bytes:
    """Give a model, which may have to be read first."""
    return data() if callable(data) else data


def safe(name: str) -> str:
    """Turn any name into a file name; different names give different ones.

    A harmless name stays as it is; another keeps its harmless letters and gets its
    hash.
    """
    if re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}", name):
        return name
    letters = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-")[:40]
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


def _block(uri: str, block: BlockModel, files: Mapping[str, str]) -> Json:
    buildings = [
        {**building, "photos": [_photo(one, files) for one in building["photos"]]}
        for building in block.record["buildings"]
    ]
    return {**block.record, "name": block.name, "uri": uri, "buildings": buildings}


def _photo(photo: Mapping[str, Any], files: Mapping[str, str]) -> Json:
    return {**photo, "file": files.get(photo["key"])}


def _text(value: Json) -> bytes:
    return json.dumps(value, ensure_ascii=False, allow_nan=False).encode()
