"""From a run's tables to the site that the world sees."""

import hashlib
import json
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from nostalgin_core import city
from pipelines.index import cleaned, of_folder
from pipelines.index.manifest import natural
from pipelines.index.roots import rooted
from pipelines.index.row import Row
from pipelines.site import site
from pipelines.site.folder import written
from pipelines.store import Damaged, Store, runs
from pipelines.store.versions import Versions

CURRENT: Final = "CURRENT"
SITE: Final = "site"


def claim(store: Store) -> None:
    """Insist that a run's site can be written, before there is anything to write.

    Raises:
        Foreign: if the folder where it would lie is not our own.
    """
    if "://" not in store.root:
        written(Path(store.root) / SITE)


def publish(
    store: Store, run: str, versions: Versions, rows: Sequence[Row], *, title: str = ""
) -> None:
    """Write the site of a run that has blocks, and only then point at the run.

    Without a `title` the city is called after its folder. A store elsewhere gets the
    pointer alone: `nostalgin build` on a machine that mounts it writes the site.

    Raises:
        Damaged: if an artifact is, before anything is written.
    """
    if "://" not in store.root:
        folder, blocks = Path(store.root), runs.read_table(store, run, "blocks")
        site.assemble(
            folder / SITE,
            blocks=models(store, run, blocks, rows),
            photos=Thumbnails(store, run, versions),
            title=cleaned(title) or of_folder(folder.resolve().name),
        )
    store.write_bytes(CURRENT, f"{run}\n".encode())


def models(
    store: Store, run: str, blocks: list[dict[str, Any]], rows: Sequence[Row]
) -> list[site.BlockModel]:
    """Gather the blocks' models, in the order of their numbers."""
    why = reasons(runs.read_table(store, run, "rejections"), rows)
    photos = runs.read_table(store, run, "photos")
    keys = {(row["root"], row["name"]): row["key"] for row in photos}
    shown = [(row, keys.get((rooted(row.root, store.root), row.photo))) for row in rows]
    taken, whose = of_buildings(shown), credits_of(shown)
    ordered = sorted(blocks, key=lambda row: natural(row["block"]))
    records = [json.loads(row["record"]) for row in ordered]
    moves = places(records, rows)
    made = []
    for row, record in zip(ordered, records, strict=True):
        move = moves[row["block"]]
        for building in record["buildings"]:
            building["rejections"] += why.get(building["id"], [])
            for photo in building["photos"]:  # it says whose the block's photos are
                photo.update(whose.get(photo["key"], {}))
            there = {photo["key"] for photo in building["photos"]}
            building["photos"] += [
                photo
                for photo in taken.get(building["id"], [])
                if photo["key"] not in there
            ]
        made.append(
            site.BlockModel(
                name=row["block"],
                glb=partial(whole, store, row["model"], row["sha256"]),
                record=record,
                low_m=tuple(row["low_m"]),
                high_m=tuple(row["high_m"]),
                origin_m=(move.east_m, move.north_m),
                turn_rad=move.turn_rad,
            )
        )
    return made


def places(records: list[dict[str, Any]], rows: Sequence[Row]) -> dict[str, city.Move]:
    """Place the blocks by the streets that their fronts share."""
    fronts: dict[str, dict[str, Any]] = defaultdict(dict)
    for row in rows:
        if row.front is not None:
            fronts[row.front.block].setdefault(row.front.front_id, row.front)
    return city.places(
        [
            city.plot(
                record["block"],
                [np.array(outline) for outline in record["outline_m"]],
                list(fronts[record["block"]].values()),
            )
            for record in records
        ]
    )


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


def credits_of(shown: Sequence[tuple[Row, str | None]]) -> dict[str, dict[str, str]]:
    """Tell whom each photo is credited to, and its rights and date, by its key."""
    whose: dict[str, dict[str, str]] = {}
    for row, key in shown:
        if key is not None:
            whose.setdefault(key, {"credit": row.credit} | row.told)
    return whose


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


def whole(store: Store, path: str, sha256: str) -> bytes:
    """Read a model, and insist that it is the one that the run has made.

    Raises:
        Damaged: if it is another.
    """
    data = cell(store, path, "glb")
    if hashlib.sha256(data).hexdigest() != sha256:
        raise Damaged("its GLB has another SHA-256 than the run says", path)
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

    def __init__(self, store: Store, run: str, versions: Versions) -> None:
        """Find out which there are."""
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
            if store.verdict(path) is True
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
