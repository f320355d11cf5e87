"""From a run's tables to the site that the world sees."""

import hashlib
import json
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from pipelines.index import Anchors, cleaned, of_folder
from pipelines.index.manifest import natural
from pipelines.index.roots import rooted
from pipelines.index.row import Row
from pipelines.site import site
from pipelines.site.folder import written
from pipelines.site.placing import Placing, placing, spot
from pipelines.site.record import credited
from pipelines.store import Damaged, Store, runs
from pipelines.store.versions import Versions

SITE: Final = "site"


def claim(store: Store) -> None:
    """Insist that a run's site can be written, before there is anything to write.

    Raises:
        Foreign: if the folder where it would lie is not our own.
    """
    if "://" not in store.root:
        written(Path(store.root) / SITE)


def publish(
    store: Store,
    run: str,
    versions: Versions,
    rows: Sequence[Row],
    *,
    title: str = "",
    anchors: Anchors | None = None,
    trusting: bool = False,
) -> tuple[str, ...]:
    """Write the site of a run that has blocks, and only then point at the run.

    `trusting`, models and pictures that stand in the site already are not opened.

    Without a `title` the city is called after its folder. A store elsewhere gets the
    pointer alone: `nostalgin build` on a machine that mounts it writes the site.
    Returns what is doubtful about the blocks' places.

    Raises:
        Damaged: if an artifact is, before anything is written.
    """
    notes: tuple[str, ...] = ()
    if "://" not in store.root:
        folder, blocks = Path(store.root), runs.read_table(store, run, "blocks")
        placed = placing(records(blocks), rows, anchors or Anchors())
        runs.write_table(store, run, "places", placed.rows)
        notes = placed.notes
        standing = site.stands(folder / SITE) if trusting else frozenset[str]()
        site.assemble(
            folder / SITE,
            blocks=models(store, run, blocks, rows, placed),
            photos=Thumbnails(store, run, versions, standing),
            title=cleaned(title) or of_folder(folder.resolve().name),
            place=placed.origin,
            trusting=trusting,
        )
    store.write_bytes(runs.CURRENT, f"{run}\n".encode())
    return notes


def records(blocks: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Read what is told of each block, in the order of their numbers."""
    ordered = sorted(blocks, key=lambda row: natural(row["block"]))
    return [json.loads(row["record"]) for row in ordered]


def models(
    store: Store,
    run: str,
    blocks: list[dict[str, Any]],
    rows: Sequence[Row],
    placed: Placing,
) -> list[site.BlockModel]:
    """Gather the blocks' models, in the order of their numbers."""
    why = reasons(runs.read_table(store, run, "rejections"), rows)
    photos = runs.read_table(store, run, "photos")
    keys = {(row["root"], row["name"]): row["key"] for row in photos}
    shown = [(row, keys.get((rooted(row.root, store.root), row.photo))) for row in rows]
    taken, words, built = of_buildings(shown), words_of(shown), years(rows)
    stand = volumes(runs.read_table(store, run, "buildings"))
    ordered = sorted(blocks, key=lambda row: natural(row["block"]))
    lying = {row["block"]: row for row in placed.rows}
    made = []
    for row, record in zip(ordered, records(blocks), strict=True):
        move = placed.moves[row["block"]]
        place, turn = placed.spots.get(row["block"], (None, move.turn_rad))
        for building in record["buildings"]:
            name = building["id"]
            building["rejections"] += why.get(name, [])
            building.update(built.get(name, {}))
            building["photos"] = photographs(building, words, taken.get(name, []))
        made.append(
            site.BlockModel(
                name=row["block"],
                glb=partial(whole, store, row["model"], row["sha256"]),
                record=record | {"place": spot(lying[row["block"]])},
                low_m=tuple(row["low_m"]),
                high_m=tuple(row["high_m"]),
                origin_m=(move.east_m, move.north_m),
                place=place,
                turn_rad=turn,
                coarse=coarse_of(store, row),
                coarse_texel_m=row["coarse_texel_m"],
                footprints_m=stand[row["block"]][0],
                heights_m=stand[row["block"]][1],
                sha256=row["sha256"],
                coarse_sha256=row["coarse_sha256"],
            )
        )
    return made


def photographs(
    building: dict[str, Any],
    words: Mapping[str, dict[str, Any]],
    taken: Sequence[dict[str, Any]],
) -> list[dict[str, Any]]:
    """List a building's photos with what their rows say, and others taken for it."""
    shown = [photo | words.get(photo["key"], {}) for photo in building["photos"]]
    for photo in shown:  # it says whose the block's photos are
        mark = photo.get("watermark", "")
        photo["credit"] = credited(photo.get("credit", ""), mark)
    there = {photo["key"] for photo in shown}
    return [*shown, *(photo for photo in taken if photo["key"] not in there)]


def of_buildings(
    shown: Sequence[tuple[Row, str | None]],
) -> dict[str, list[dict[str, Any]]]:
    """List all photos of each building: those that it could not use are shown too.

    `shown` gives each row with the key of its photo, if that could be read.
    """
    told: dict[str, dict[str, dict[str, Any]]] = defaultdict(dict)
    for row, key in shown:
        if row.front is not None and key is not None:
            photo = {"key": key, "used": False, "caption": row.photo}
            building = f"{row.front.block}-{row.front.lot}"
            told[building][key] = photo | {"credit": row.credit} | row.told
    return {building: list(own.values()) for building, own in told.items()}


def words_of(shown: Sequence[tuple[Row, str | None]]) -> dict[str, dict[str, str]]:
    """Tell whom each photo is credited to, by its key, and what else is said of it."""
    words: dict[str, dict[str, str]] = {}
    for row, key in shown:
        if key is not None:
            words.setdefault(key, {"credit": row.credit} | row.told)
    return words


def years(rows: Sequence[Row]) -> dict[str, dict[str, str]]:
    """Tell when buildings were built, as far as their rows do."""
    known: dict[str, dict[str, str]] = {}
    for row in rows:
        year = str(row.cells.get("year") or "").strip()
        if row.front is not None and year:
            known.setdefault(f"{row.front.block}-{row.front.lot}", {"year": year})
    return known


def volumes(buildings: list[dict[str, Any]]) -> dict[str, tuple[Any, Any]]:
    """Gather each block's footprints and heights, to be drawn from far away."""
    told = defaultdict(list)
    for one in buildings:
        told[one["block"]].append(one)
    return {
        block: (
            np.array([one["footprint_m"] for one in own]).reshape(-1, 4, 2),
            np.array([one["height_m"] for one in own]),
        )
        for block, own in told.items()
    }


def coarse_of(store: Store, row: dict[str, Any]) -> Callable[[], bytes] | None:
    """Tell how to read a block's model for those far away, if there is one."""
    sha256 = row["coarse_sha256"]
    if not sha256:
        return None
    return partial(whole, store, row["model"], sha256, "coarse")


def reasons(
    rejections: list[dict[str, Any]], rows: Sequence[Row]
) -> dict[str, list[dict[str, str]]]:
    """Tell for each building what went wrong with its photos."""
    lots = defaultdict(set)
    for row in rows:
        if row.front is not None and row.photo:
            lots[row.photo].add(f"{row.front.block}-{row.front.lot}")
    told = defaultdict(list)
    for one in rejections:
        for building in sorted(lots.get(one["key"], ())):
            named = {name: one[name] or "" for name in ("stage", "reason", "detail")}
            told[building].append(named | {"photo": one["key"]})
    return told


def cell(store: Store, path: str, column: str) -> bytes:
    """Read the one cell that an artifact holds."""
    return store.read_table(path, [column]).to_pylist()[0][column]


def whole(store: Store, path: str, sha256: str, column: str = "glb") -> bytes:
    """Read a model, and insist that it is the one that the run has made.

    Raises:
        Damaged: if it is another.
    """
    data = cell(store, path, column)
    if hashlib.sha256(data).hexdigest() != sha256:
        raise Damaged(f"its {column} has another SHA-256 than the run says", path)
    return data


def damaged(store: Store, run: str, versions: Versions) -> list[str]:
    """List what a run would publish and can't: artifacts that are damaged or gone."""
    models = runs.read_table(store, run, "blocks")
    photos = runs.read_table(store, run, "photos")
    keys = [versions.thumbnail_key(row["sha256"]) for row in photos]
    small = [versions.path("thumbnail", key) for key in dict.fromkeys(keys)]
    found = []
    for path, sha256 in (
        *((row["model"], row["sha256"]) for row in models),
        *((path, "") for path in small),
    ):
        try:
            if sha256:
                whole(store, path, sha256)
            elif store.verdict(path) is True:
                store.read_table(path)
        except Damaged:
            found.append(path)
    return found


class Thumbnails(Mapping[str, bytes]):
    """The small pictures of all photos that could be read, by key, read one by one."""

    def __init__(
        self,
        store: Store,
        run: str,
        versions: Versions,
        standing: AbstractSet[str] = frozenset(),
    ) -> None:
        """Find out which there are; what is `standing` in the site, is there."""
        self._store = store
        self._paths = {
            row["key"]: versions.path(
                "thumbnail", versions.thumbnail_key(row["sha256"])
            )
            for row in runs.read_table(store, run, "photos")
        }
        self._paths = {
            key: path
            for key, path in sorted(self._paths.items())
            if f"photos/{site.safe(key)}.webp" in standing
            or store.verdict(path) is True
        }

    def __getitem__(self, key: str) -> bytes:
        """Read one."""
        return cell(self._store, self._paths[key], "picture")

    def __iter__(self) -> Iterator[str]:
        """Name all."""
        return iter(self._paths)

    def __len__(self) -> int:
        """Count them."""
        return len(self._paths)
