"""What a city folder knows of its blocks' places on the globe, and how it got there."""

import contextlib
import hashlib
from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final, TypeVar

from nostalgin_core import city
from nostalgin_core.city import Anchor
from pipelines import bounded
from pipelines.index import outlines, places
from pipelines.index.geojson import NoOutlines
from pipelines.index.images import Nothing
from pipelines.index.manifest import natural
from pipelines.store import Store

FILES: Final = (outlines.OUTLINES, places.PLACES, places.STREETS)
MOST_TOLD: Final = 10  # faults of one file; more are counted

Read = TypeVar("Read")


@dataclass(frozen=True)
class Asked:
    """What `index` is told of places: files, and one place for the whole city."""

    outlines: Path | None = None
    outline_key: str = ""
    outline_crs: str = ""
    places: Path | None = None
    place: str = ""
    streets: Path | None = None


@dataclass(frozen=True)
class Anchors:
    """Places by block, streets' widths, and what was wrong with some of them."""

    of: dict[str, Anchor] = field(default_factory=dict)
    widths_m: dict[str, float] = field(default_factory=dict)
    gaps_m: dict[str, float] = field(default_factory=dict)  # inside blocks of two parts
    warnings: tuple[str, ...] = ()
    sha256: str = ""  # of the files; empty where there is none


def taken(
    asked: Asked, blocks: Collection[str]
) -> tuple[dict[str, bytes], tuple[str, ...]]:
    """Read what is told of places; give the city folder's files, and warnings.

    Raises:
        Nothing: if a file can't be used, or names none of the blocks.
    """
    files: dict[str, bytes] = {}
    told: list[str] = []
    whole: dict[str, Anchor] = {}
    if asked.places is not None:
        path = asked.places
        whole, faults = of_file(path, lambda d: places.read(d, path.name))
        told += [*few("", faults), *missing(path, whole, blocks)]
    if asked.outlines is not None:
        path = asked.outlines
        known = {"key": asked.outline_key, "crs": asked.outline_crs, "points": whole}
        found, faults = of_file(path, lambda d: outlines.read(d, blocks, **known))
        files[outlines.OUTLINES] = outlines.written(found, path.name)
        told += [*few(path, faults), *missing(path, found, blocks)]
    if asked.places is not None or asked.place:
        try:
            more = {places.WHOLE: places.place(asked.place)} if asked.place else {}
        except places.NoPlaces as problem:
            raise Nothing(str(problem)) from problem
        files[places.PLACES] = places.written(whole | more)
    if asked.streets is not None:
        path = asked.streets
        _, faults = of_file(path, lambda d: places.streets(d, path.name))
        files[places.STREETS] = bounded.read(path, bounded.TABLE_BYTES)
        told += few("", faults)
    return files, tuple(told)


def of_file(path: Path, read: Callable[[bytes], Read]) -> Read:
    """Read a file that was named.

    Raises:
        Nothing: if it can't be used.
    """
    try:
        return read(bounded.read(path, bounded.TABLE_BYTES))
    except OSError as problem:
        raise Nothing(f"{path}: {problem.strerror}; name another file") from problem
    except (NoOutlines, places.NoPlaces) as problem:
        raise Nothing(f"{path} {problem}") from problem


def told_of_places(store: Store) -> bool:
    """Tell whether the city folder knows where any block lies."""
    return any(store.exists(name) for name in FILES)


def keep(store: Store, folder: str) -> None:
    """Copy what the city folder knows into one of its folders, where `load` reads it.

    A file that can't be read is left out, as `load` leaves it out.
    """
    found: dict[str, bytes] = {}
    for name in FILES:
        if store.exists(name):
            with contextlib.suppress(OSError):
                found[name] = store.read_bytes(name, bounded.TABLE_BYTES)
    for name, data in found.items():
        store.write_bytes(f"{folder}/{name}", data)


def load(store: Store, blocks: Collection[str]) -> Anchors:
    """Read what the city folder knows; a file that can't be used is told, and left out.

    A block's bearing in places.csv counts for its outline as well, and an outline
    before a point. The whole city's place is its first block's, if that has no other.
    """
    own: dict[str, bytes] = {}
    told: list[str] = []
    for name in FILES:
        if store.exists(name):
            try:
                own[name] = store.read_bytes(name, bounded.TABLE_BYTES)
            except OSError as problem:
                told.append(f"{store.root}/{name}: {problem.strerror}; left out")
    readers = {
        outlines.OUTLINES: lambda data: outlines.read(data, blocks),
        places.PLACES: lambda data: places.read(data, places.PLACES),
        places.STREETS: lambda data: places.streets(data, places.STREETS),
    }
    found: dict[str, dict] = {name: {} for name in FILES}
    for name, data in own.items():
        try:
            found[name], faults = readers[name](data)
            told += few(name if name == outlines.OUTLINES else "", faults)
        except (NoOutlines, places.NoPlaces) as problem:
            told.append(f"{name} {problem}; it is left out")
    digest = hashlib.sha256(b"".join(hashlib.sha256(d).digest() for d in own.values()))
    sha256 = digest.hexdigest() if own else ""
    anchors = joined(found[outlines.OUTLINES], found[places.PLACES], blocks)
    gaps_m = {block: city.gap_m(one) for block, one in anchors.items()}
    known_m = {block: gap for block, gap in gaps_m.items() if gap is not None}
    return Anchors(anchors, found[places.STREETS], known_m, tuple(told), sha256)


def joined(
    outlined: dict[str, Anchor], pointed: dict[str, Anchor], blocks: Collection[str]
) -> dict[str, Anchor]:
    """Join outlines and points, block by block."""
    plain = {outlines.plain(name): name for name in blocks}
    points = {plain.get(outlines.plain(n), n): one for n, one in pointed.items()}
    whole = points.pop(places.WHOLE, None)
    if whole is not None and blocks:
        points.setdefault(min(blocks, key=natural), whole)
    both = {
        block: replace(one, bearing_deg=points[block].bearing_deg)
        for block, one in outlined.items()
        if block in points
    }
    return {**points, **outlined, **both}


def missing(path: Path, found: Collection[str], blocks: Collection[str]) -> list[str]:
    """Say which blocks have no place, and which places no block."""
    known = {outlines.plain(one) for one in found}
    none = [one for one in blocks if outlines.plain(one) not in known]
    strange = known - {outlines.plain(one) for one in blocks} - {places.WHOLE}
    told = []
    if none:
        words = "stand by their streets"
        told.append(f"{path} does not place {outlines.few(none)}: they {words}")
    if strange:
        told.append(f"{path} places {outlines.few(sorted(strange))}: no such block")
    return told


def few(where: object, faults: list[str]) -> list[str]:
    """Tell the first faults of a file, and count the others."""
    told = [f"{where}: {one}" if where else one for one in faults[:MOST_TOLD]]
    more = len(faults) - MOST_TOLD
    return [*told, f"{where or 'and'}: {more} more like these"] if more > 0 else told
