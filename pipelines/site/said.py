"""What a block's rows of the manifest add to what a run knows of its buildings.

A row here is plain: `photo` and `key` (none, if it could not be read), `front`,
`credit`, `said` (what else is told of the photo), `year`, and the `rejections` of its
photo. Rows come in the manifest's order.
"""

import json
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from pipelines.site.record import credited

Json = dict[str, Any]


def said(record: Json, rows: Sequence[Json]) -> Json:
    """Add to a block's record what its rows say."""
    why, built = reasons(rows), years(rows)
    taken, words = of_buildings(rows), words_of(rows)
    for building in record["buildings"]:
        name = building["id"]
        building["rejections"] += why.get(name, [])
        building.update(built.get(name, {}))
        building["photos"] = photographs(building, words, taken.get(name, []))
    return record


def building_of(row: Mapping[str, Any]) -> str:
    """Name the building that a row's front is of."""
    return f"{row['front']['block']}-{row['front']['lot']}"


def photographs(
    building: Json, words: Mapping[str, Json], taken: Sequence[Json]
) -> list[Json]:
    """List a building's photos with what their rows say, and others taken for it."""
    shown = [photo | words.get(photo["key"], {}) for photo in building["photos"]]
    for photo in shown:  # it says whose the block's photos are
        mark = photo.get("watermark", "")
        photo["credit"] = credited(photo.get("credit", ""), mark)
    there = {photo["key"] for photo in shown}
    return [*shown, *(photo for photo in taken if photo["key"] not in there)]


def of_buildings(rows: Sequence[Json]) -> dict[str, list[Json]]:
    """List all photos of each building: those that it could not use are shown too."""
    told: dict[str, dict[str, Json]] = defaultdict(dict)
    for row in rows:
        if row["key"] is not None:
            photo = {"key": row["key"], "used": False, "caption": row["photo"]}
            own = photo | {"credit": row["credit"]} | row["said"]
            told[building_of(row)][row["key"]] = own
    return {building: list(own.values()) for building, own in told.items()}


def words_of(rows: Sequence[Json]) -> dict[str, dict[str, str]]:
    """Tell whom each photo is credited to, by its key, and what else is said of it.

    A photo that rows of several blocks name is credited in each as its own rows say.
    """
    words: dict[str, dict[str, str]] = {}
    for row in rows:
        if row["key"] is not None:
            words.setdefault(row["key"], {"credit": row["credit"]} | row["said"])
    return words


def years(rows: Sequence[Json]) -> dict[str, dict[str, str]]:
    """Tell when buildings were built, as far as their rows do."""
    known: dict[str, dict[str, str]] = {}
    for row in rows:
        if row["year"]:
            known.setdefault(building_of(row), {"year": row["year"]})
    return known


def reasons(rows: Sequence[Json]) -> dict[str, list[dict[str, str]]]:
    """Tell for each building what went wrong with its photos, each once."""
    told: dict[str, dict[str, Json]] = defaultdict(dict)
    for row in rows:
        for why in row["rejections"]:
            told[building_of(row)][json.dumps(why, sort_keys=True)] = why
    return {
        building: [
            {name: one[name] or "" for name in ("stage", "reason", "detail")}
            | {"photo": one["key"]}
            for _, one in sorted(own.items())
        ]
        for building, own in told.items()
    }
