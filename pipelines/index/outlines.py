"""Outlines of buildings, each with its block's key, become outlines of blocks.

    CITY/outlines.geojson      a feature a block, as `index --outlines` wrote it

It can be mended in any map program: `build` reads it as `index` reads others' files.
"""

import json
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from typing import Any, Final

import numpy as np
import shapely

from nostalgin_core import city
from nostalgin_core.city import Anchor
from pipelines.index.geojson import Feature, NoOutlines, features

OUTLINES: Final = "outlines.geojson"
KEYS: Final = ("block", "tax_block", "taxblock", "block_id", "blockid", "bbl")
SHEETS: Final = ("sheet", "layer")
NAMED: Final = 8  # keys or blocks in a message; more drown it
DIGITS: Final = 8  # of a degree: millimetres
SHARED: Final = 0.5  # of the smaller outline: two blocks have one


def read(
    data: bytes,
    blocks: Collection[str],
    *,
    key: str = "",
    crs: str = "",
    points: Mapping[str, Anchor] | None = None,
) -> tuple[dict[str, Anchor], list[str]]:
    """Read the outlines of blocks, and tell what is wrong with some of them.

    Outlines that do not say whose they are go to the blocks on whose `points` they lie.
    Of several buildings of a block its outline is made (`city.united`). Two blocks that
    share an outline get none.

    Raises:
        NoOutlines: if there is none of these blocks.
    """
    found = features(data, crs)
    usable = [one for one in found if one.shape is not None]
    told = [f"feature {one.number} {one.fault}" for one in found if one.fault]
    wanted = {plain(block): block for block in blocks}
    here = {wanted[n]: p for n, p in pointed(points or {}).items() if n in wanted}
    if here and not key and not known_key(usable):
        own, mend = by_place(usable, here), "place"
    else:
        mend = key_of(usable, key)
        own = by_key(usable, mend, wanted)
    anchors = {block: made(those) for block, those in sorted(own.items())}
    anchors = {block: one for block, one in anchors.items() if one is not None}
    twins = shared(anchors)
    for a, b in twins:
        told.append(
            f"blocks {a} and {b} have one outline (features {numbers(own[a])} and "
            f"{numbers(own[b])}): both stand by their streets; mend one's {mend!r}"
        )
    gone = {block for pair in twins for block in pair}
    return {block: one for block, one in anchors.items() if block not in gone}, told


def by_key(
    usable: Sequence[Feature], name: str, wanted: Mapping[str, str]
) -> dict[str, list[Feature]]:
    """Sort outlines by the property that names their blocks.

    Raises:
        NoOutlines: if there is none of these blocks.
    """
    own: dict[str, list[Feature]] = defaultdict(list)
    for one in usable:
        block = wanted.get(block_of(name, one.properties.get(name)))
        if block is not None:
            own[block].append(one)
    if not own:
        keys = [str(one.properties.get(name))[:40] for one in usable]
        raise NoOutlines(
            f"has no outline of these blocks: its {name!r} is {few(keys)}, the blocks "
            f"are {few(list(wanted.values()))}: is it another city's? or name another "
            "--outline-key"
        )
    return own


def by_place(
    usable: Sequence[Feature], points: Mapping[str, Anchor]
) -> dict[str, list[Feature]]:
    """Give each block the island of outlines on which its point lies.

    Raises:
        NoOutlines: if none lies on any.
    """
    at = np.array([[p.longitude_deg, p.latitude_deg] for p in points.values()])
    shapes = [one.shape for one in usable if one.shape is not None]
    sheets = [sheet_of(one.properties) for one in usable]
    found = city.islands(shapes, sheets, at)
    own = {
        block: [usable[i] for i in those]
        for block, those in zip(points, found, strict=True)
        if those
    }
    if not own:
        raise NoOutlines(
            "does not say whose outlines, and none lies where the places of blocks "
            f"{few(list(points))} are: is it another city's? or name an --outline-key"
        )
    return own


def pointed(points: Mapping[str, Anchor]) -> dict[str, Anchor]:
    """Name places as outlines name blocks."""
    return {plain(name): one for name, one in points.items()}


def known_key(found: Sequence[Feature]) -> str:
    """Find a property that usually names blocks; empty if there is none."""
    names = sorted({name for one in found for name in one.properties})
    return next((n for key in KEYS for n in names if n.casefold() == key), "")


def key_of(found: Sequence[Feature], asked: str) -> str:
    """Choose the property that names the blocks.

    Raises:
        NoOutlines: if there is none.
    """
    names = Counter(name for one in found for name in one.properties)
    if asked in names:
        return asked
    if known_key(found) and not asked:
        return known_key(found)
    words = f"has no property {asked!r}" if asked else "does not say whose outlines"
    raise NoOutlines(
        f"{words}: its features have {few(sorted(names)) or 'none'}; name one by "
        "--outline-key, join a block's number to each outline in a map program, or "
        "give each block a point by --places too: then it gets the outlines there"
    )


def block_of(name: str, value: Any) -> str:
    """Read a block's name; in a BBL it stands between borough and lot."""
    text = plain(value)
    if name.casefold().endswith("bbl") and text.isdecimal() and len(text) == 10:
        return plain(text[1:6])
    return text


def plain(value: Any) -> str:
    """Write a block's name in one way: 00993, 993 and 993.0 are one block."""
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    text = "" if value is None else str(value).strip()
    return text.lstrip("0") or "0" if text.isdecimal() else text.casefold()


def made(those: Sequence[Feature]) -> Anchor | None:
    """Unite the outlines of one block."""
    shapes = [one.shape for one in those if one.shape is not None]
    sheets = [sheet_of(one.properties) for one in those]
    outline = city.united(shapes, sheets)
    if not outline:
        return None
    spot = shapely.MultiPolygon([(part,) for part in outline]).centroid
    return Anchor(float(spot.x), float(spot.y), outline_deg=outline)


def sheet_of(properties: Mapping[str, Any]) -> str:
    """Tell on which sheet of a map an outline was drawn, if it says so."""
    told = {name.casefold(): value for name, value in properties.items()}
    return next((str(told[name]) for name in SHEETS if name in told), "")


def shared(anchors: Mapping[str, Anchor]) -> list[tuple[str, str]]:
    """List the pairs of blocks whose outlines are one and the same."""
    names = list(anchors)
    shapes = [
        shapely.union_all(
            [shapely.make_valid(shapely.Polygon(p)) for p in a.outline_deg]
        )
        for a in anchors.values()
    ]
    if not shapes:
        return []
    first, second = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    return sorted(
        (names[a], names[b])
        for a, b in zip(first, second, strict=True)
        if a < b
        and shapes[a].intersection(shapes[b]).area
        > SHARED * min(shapes[a].area, shapes[b].area)
    )


def written(anchors: Mapping[str, Anchor], source: str) -> bytes:
    """Write outlines as GeoJSON, a block a line, so that `read` gives them back."""
    lines = [
        json.dumps(
            {
                "type": "Feature",
                "properties": {"block": block, "from": source},
                "geometry": {
                    "type": "MultiPolygon",
                    "coordinates": [[ring(part)] for part in one.outline_deg],
                },
            }
        )
        for block, one in sorted(anchors.items())
    ]
    body = ",\n".join(lines)
    return f'{{"type": "FeatureCollection", "features": [\n{body}\n]}}\n'.encode()


def ring(part: np.ndarray) -> list[list[float]]:
    """Close a ring."""
    rows = np.round(part, DIGITS).tolist()
    return [*rows, rows[0]]


def numbers(those: Sequence[Feature]) -> str:
    """Name features by their numbers."""
    return few([str(one.number) for one in those])


def few(words: Collection[str]) -> str:
    """Name the first of many."""
    every = list(dict.fromkeys(words))
    more = f" and {len(every) - NAMED} more" if len(every) > NAMED else ""
    return ", ".join(every[:NAMED]) + more
