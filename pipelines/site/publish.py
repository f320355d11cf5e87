"""From a run's tables to the site that the world sees."""

import hashlib
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import chain, repeat
from pathlib import Path
from typing import Any, Final

from pipelines.index import Anchors, cleaned, of_folder
from pipelines.site import site
from pipelines.site.aside import Aside
from pipelines.site.folder import written
from pipelines.site.joined import Joined, joined
from pipelines.site.placing import Placing, placing, spot
from pipelines.site.thumbnails import Thumbnails, hashes, path_of
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
        folder = Path(store.root)
        with Aside(folder) as aside:
            blocks = joined(store, run, aside)
            placed = placing([one.plot for one in blocks], anchors or Anchors())
            runs.write_table(store, run, "places", placed.rows)
            notes = placed.notes
            standing = site.stands(folder / SITE) if trusting else frozenset[str]()
            site.assemble(
                folder / SITE,
                blocks=models(store, blocks, placed),
                photos=Thumbnails(store, run, versions, standing),
                title=cleaned(title) or of_folder(folder.resolve().name),
                place=placed.origin,
                trusting=trusting,
            )
    store.write_bytes(runs.CURRENT, f"{run}\n".encode())
    return notes


def models(
    store: Store, blocks: Sequence[Joined], placed: Placing
) -> list[site.BlockModel]:
    """Tell what a site needs of the blocks, and how to read the rest."""
    lying = {row["block"]: row for row in placed.rows}
    made = []
    for one in blocks:
        row, name = one.row, one.row["block"]
        move = placed.moves[name]
        place, turn = placed.spots.get(name, (None, move.turn_rad))
        made.append(
            site.BlockModel(
                name=name,
                glb=partial(whole, store, row["model"], row["sha256"]),
                record=partial(recorded, one, lying[name]),
                low_m=tuple(row["low_m"]),
                high_m=tuple(row["high_m"]),
                origin_m=(move.east_m, move.north_m),
                place=place,
                turn_rad=turn,
                coarse=coarse_of(store, row),
                coarse_texel_m=row["coarse_texel_m"],
                footprints_m=one.footprints_m,
                heights_m=one.heights_m,
                sha256=row["sha256"],
                coarse_sha256=row["coarse_sha256"],
            )
        )
    return made


def recorded(one: Joined, lying: dict[str, Any]) -> dict[str, Any]:
    """Read a block's record, and tell there where the block lies."""
    return one.record() | {"place": spot(lying)}


def coarse_of(store: Store, row: dict[str, Any]) -> Callable[[], bytes] | None:
    """Tell how to read a block's model for those far away, if there is one."""
    sha256 = row["coarse_sha256"]
    if not sha256:
        return None
    return partial(whole, store, row["model"], sha256, "coarse")


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


def each_model(store: Store, run: str) -> Iterator[tuple[str, str]]:
    """Name the artifacts of a run's models, and their hashes."""
    for part in runs.each_part(store, run, "blocks", ["model", "sha256"]):
        yield from ((row["model"], row["sha256"]) for row in part.to_pylist())


def damaged(store: Store, run: str, versions: Versions) -> list[str]:
    """List what a run would publish and can't: artifacts that are damaged or gone."""
    found = []
    small = (path_of(versions, bytes(one).decode()) for one in hashes(store, run))
    for path, sha256 in chain(each_model(store, run), zip(small, repeat(""))):
        try:
            if sha256:
                whole(store, path, sha256)
            elif store.verdict(path) is True:
                store.read_table(path)
        except Damaged:
            found.append(path)
    return found
