"""All views of one front, laid over each other, and what came from where."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import cv2
import numpy as np
from jaxtyping import UInt8

from nostalgin_core import borrow
from nostalgin_core.records import Elevation
from pipelines.explain import draw, panel
from pipelines.explain.draw import Colour

if TYPE_CHECKING:
    from pipelines.store import Store  # slow to load: `explain` needs none

Json = dict[str, Any]
APART: Final = 96  # gray: nothing lies there


class Unshown(ValueError):  # noqa: N818 - it reads as what it is about
    """A front that a city can't tell of, with what to do about it."""


def explain_front(city: Path, front: str, out: Path) -> Json:
    """Write every view of a front, a sheet of all, and `front.json`.

    Returns: what `front.json` says.

    Raises:
        Unshown: if no wall wears the front, or what it was made of is gone.
    """
    from pipelines.store import Damaged, Store, runs

    store = Store(str(city))
    try:
        run = runs.shown(store)
        row = chosen(runs.read_rows(store, run, "borrowed"), front)
        tiles, report = told(store, run, row)
    except (FileNotFoundError, Damaged) as problem:
        words = f"{city} lacks what {front} was made of: build it again ({problem})"
        raise Unshown(words) from problem
    out.mkdir(parents=True, exist_ok=True)
    for number, (_, picture) in enumerate(tiles):
        save(out / f"{number:02}.png", picture)
    captioned = [panel.captioned(*tile) for tile in tiles]
    save(out / "sheet.png", panel.rows(captioned))
    report["pictures"] = [name for name, _ in tiles]
    (out / "front.json").write_text(json.dumps(report, indent=1) + "\n")
    return report


def save(path: Path, picture: Colour) -> None:
    """Write a PNG."""
    path.write_bytes(cv2.imencode(".png", picture)[1].tobytes())


def chosen(rows: Any, front: str) -> Json:
    """Find a front's row.

    Raises:
        Unshown: if there is none.
    """
    known = {row["front_id"]: row for row in rows}
    if front not in known:
        near = ", ".join(sorted(known)[:3])
        raise Unshown(f"no wall wears front {front}: name one of those worn, as {near}")
    return known[front]


def told(store: "Store", run: str, row: Json) -> tuple[list[panel.Tile], Json]:
    """Draw a front's views and what was lent, and write the numbers."""
    from pipelines.store import runs, tables

    facades = list(runs.read_rows(store, run, "facades"))
    own = elevation(store, facades, row["name"], row["facade"])
    tiles = [(f"own: {row['name']}", draw.in_colour(own.image))]
    names = {one["photo"]: one["name"] for one in facades}
    views = [
        {**fit, "photo": names.get(fit["photo"], fit["photo"])}
        for fit in json.loads(row["fits"])
    ]
    tiles += [laid(store, facades, own, fit) for fit in views]
    if row["borrowed"]:
        made = store.read_table(row["borrowed"][0])
        view = tables.records(Elevation, made)[0]
        sources = tables.from_png(made.to_pylist()[0]["sources"])
        tiles += [
            ("filled by neighbours", draw.in_colour(view.image)),
            ("evidence", draw.evidence_colours(view.evidence)),
            ("which photograph", coloured(sources)),
        ]
    report = {
        **{name: row[name] for name in ("front_id", "facade", "unseen", "left")},
        "photo": row["name"],
        "views": views,
        "sources": [names.get(key, key) for key in row["photos"]],
    }
    return tiles, report


def elevation(store: "Store", facades: list[Json], name: str, facade: int) -> Elevation:
    """Read a facade's elevation, as `rectify` left it."""
    from pipelines.store import tables

    path = next(
        one["elevations"]
        for one in facades
        if (one["name"], one["facade"]) == (name, facade)
    )
    rows = store.read_table(path).to_pylist()
    row = next(one for one in rows if one["facade"] == facade and not one["reason"])
    return tables.from_row(Elevation, row)


def laid(store: "Store", facades: list[Json], own: Elevation, fit: Json) -> panel.Tile:
    """Draw a lender's view as it lies over the own."""
    name = fit["photo"]
    if not fit["fits"]:
        return f"{name}: apart", np.full((*own.image.shape, 3), APART, np.uint8)
    other = elevation(store, facades, name, fit["facade"])
    view = borrow.over(own, other)
    if view is None:
        return f"{name}: apart", np.full((*own.image.shape, 3), APART, np.uint8)
    picture = np.where(view.known, view.image, np.uint8(APART)).astype(np.uint8)
    return f"{name}: {fit['lent']} texels", draw.in_colour(picture)


def coloured(sources: UInt8[np.ndarray, "h w"]) -> Colour:
    """Give each photograph of a source map a colour."""
    palette = np.zeros((256, 3), np.uint8)
    for number in range(1, int(sources.max(initial=0)) + 1):
        palette[number] = draw.facade_colour(number - 1)
    return palette[sources]
