"""What the viewer tells of a block: its outlines and its buildings, as plain values."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from nostalgin_core.model import address
from nostalgin_core.records import (
    Assignment,
    Block,
    Building,
    Front,
    Rejection,
    Seen,
    Standpoint,
    Texture,
    Wall,
)
from pipelines.site.camera import cameras

Json = dict[str, Any]
CENTIMETRE: Final = 2  # digits


def record(
    block: Block,
    *,
    fronts: Iterable[Front],
    assignments: Iterable[Assignment],
    seen: Iterable[Seen],
    photos: Mapping[str, Mapping[str, Any]],
    stood: Mapping[Texture, Standpoint] | None = None,
    rejections: Mapping[str, Sequence[Rejection]] | None = None,
    more: Mapping[str, Mapping[str, Any]] | None = None,
) -> Json:
    """Write what is known of a block.

    `photos` maps the key of each photo to what is told of it (`credit`, `caption`);
    one that is `lent` is a record of a neighbour, and shows this building as well;
    `stood` tells of facades where their photo's camera stood;
    `rejections` and `more` (a year, say) map building ids. Lengths are metres, rounded
    to centimetres; `photographed_share` is the share of a building's fronts, by width,
    that a camera saw; `height_low_m` to `height_high_m` hold the height in nine of ten
    cases, and `height_assumed` says that nothing supports it. `footprint_m` is
    anticlockwise from the first front's left end.
    """
    by_id = {front.front_id: front for front in fronts}
    facades = {(one.photo, one.facade): one for one in seen}
    ordered = sorted(assignments, key=lambda one: (-one.score, one.photo))
    showing: dict[str, list[Assignment]] = {}
    for one in ordered:
        showing.setdefault(one.front_id, []).append(one)
    return {
        "block": block.block,
        "outline_m": [_rounded(outline) for outline in block.outline_m],
        "buildings": [
            {
                **_building(
                    one,
                    by_id,
                    facades,
                    showing,
                    _placed(photos, cameras(one, ordered, stood or {})),
                ),
                "rejections": [
                    _rejection(why)
                    for why in (rejections or {}).get(one.building_id, ())
                ],
                **(more or {}).get(one.building_id, {}),
            }
            for one in block.buildings
        ],
    }


def credited(credit: str, watermark: str) -> str:
    """Add what a watermark said that was taken out to whom is credited, if it lacks."""
    own = [] if watermark.casefold() in credit.casefold() else [watermark]
    return "; ".join([*([credit] if credit else []), *own])


def _building(
    building: Building,
    fronts: Mapping[str, Front],
    facades: Mapping[Texture, Seen],
    showing: Mapping[str, Sequence[Assignment]],
    photos: Mapping[str, Mapping[str, Any]],
) -> Json:
    names = [wall.front_id for wall in building.walls if wall.front_id is not None]
    own = [fronts[name] for name in names if name in fronts]
    own.sort(key=lambda front: (front.ring, front.rank))
    worn = [wall.texture[0] for wall in building.walls if wall.texture]
    shown = [one for front in own for one in showing.get(front.front_id, ())]
    keys = list(dict.fromkeys([*worn, *(one.photo for one in shown)]))
    lent = {one.photo for one in shown if one.lent}
    return {
        "id": building.building_id,
        "lot": own[0].lot if own else building.building_id,
        "address": address(own),
        "street": ", ".join(
            dict.fromkeys(front.street for front in own if front.street)
        ),
        "fronts": [front.front_id for front in own],
        "photos": [
            {
                "key": key,
                "used": key in worn,
                **({"lent": True} if key in lent else {}),
                **photos.get(key, {}),
            }
            for key in keys
        ],
        "width_m": round(
            own[0].width_m if own else _width(building.walls[0]), CENTIMETRE
        ),
        "width_assumed": bool(own and own[0].width_assumed),
        "height_m": round(building.height_m, CENTIMETRE),
        **_height(building),
        "footprint_m": _rounded(building.footprint_m, CENTIMETRE),
        "assumed": building.assumed,
        "photographed_share": round(_share(building, facades), 3),
    }


def _placed(
    photos: Mapping[str, Mapping[str, Any]], placed: Mapping[str, Json]
) -> dict[str, Json]:
    """Add to what is told of photos where they were taken from."""
    told = {key: dict(one) for key, one in photos.items()}
    for key, one in placed.items():
        told.setdefault(key, {})["camera"] = one
    return told


def _fronts(building: Building) -> list[Wall]:
    return [wall for wall in building.walls if wall.front_id is not None]


def _width(wall: Wall) -> float:
    return float(np.hypot(*np.subtract(wall.end_m, wall.start_m)))


def _height(building: Building) -> Json:
    """Tell how the height is known: its interval, and what each witness says of it."""
    known = building.height
    if known is None:
        return {"height_assumed": True}
    told = {
        "height_low_m": known.low_m,
        "height_high_m": known.high_m,
        "height_by_storeys_m": known.by_storeys_m,
        "height_by_width_m": known.by_width_m,
        "height_by_list_m": known.by_list_m,
    }
    rounded = {n: round(v, CENTIMETRE) for n, v in told.items() if v is not None}
    against = list(known.contradicting)
    if against:
        rounded |= {"height_contradicted_by": against}
    return {**rounded, "height_assumed": not known.supported}


def _share(building: Building, facades: Mapping[Texture, Seen]) -> float:
    walls = _fronts(building)
    widths = [_width(wall) for wall in walls]
    shares = [_photographed(wall, facades) for wall in walls]
    whole = sum(widths)
    return float(np.dot(widths, shares) / whole) if whole > 0 else 0.0


def _photographed(wall: Wall, facades: Mapping[Texture, Seen]) -> float:
    if wall.texture is None or wall.evidence is not None:
        return 0.0
    known = facades.get(wall.texture)
    return known.photographed if known else 0.0


def _rounded(outline: np.ndarray, digits: int = 3) -> list[list[float]]:
    return [[float(value) + 0.0 for value in row] for row in np.round(outline, digits)]


def _rejection(why: Rejection) -> Json:
    return {"stage": why.stage, "reason": why.reason, "detail": why.detail}
