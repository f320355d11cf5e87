"""An earlier run that is kept is shown again, from its own tables and artifacts.

It is published as a build publishes it: files named by content first, then site.json in
one move, and the pointer last. Nothing is made, and no photograph is opened.
"""

from collections.abc import Iterator
from typing import Final

from pipelines import build, index, site
from pipelines.build import Tell
from pipelines.index import asked
from pipelines.index.manifest import natural
from pipelines.index.row import Row
from pipelines.reprocess.merged import SUBJECT
from pipelines.reprocess.published import Published
from pipelines.store import Damaged, Store, held, runs
from pipelines.store.refuse import began, record
from pipelines.store.versions import Versions

UNDECODED: Final = frozenset({"photo", "thumbnail"})  # no picture of these
REMEDY: Final = (
    "restore it from a backup, or show another; to keep what the last N runs need, "
    "call `nostalgin gc` with --keep N"
)


class Unkept(ValueError):  # noqa: N818 - it reads as what it is about
    """A run that can't be shown again, with the reason and the remedy."""


def rollback(store: Store, run: str, *, tell: Tell = build.silent) -> None:
    """Show a run again that was shown before.

    Raises:
        Unkept: if it never was, or something that it needs is gone or damaged.
        Foreign: if the folder for the site holds what another wrote.
        Busy: if another run is at work in the city folder.
    """
    with held(store):
        if run not in shown(store):
            there = ", ".join(shown(store)) or "none"
            words = f"{store.root} keeps no run {run} that was shown; it keeps: {there}"
            raise Unkept(words)
        site.claim(store)
        before = Published(store, run, record(store, run))
        try:
            again(before, tell)
        except (Damaged, FileNotFoundError) as problem:
            raise Unkept(f"run {run} can't be shown: {problem}; {REMEDY}") from problem


def shown(store: Store) -> list[str]:
    """Name the kept runs that were shown once, the latest first."""
    names = [one for one in store.names("runs") if runs.was_shown(store, one)]
    return sorted(names, key=lambda run: began(store, run), reverse=True)


def again(before: Published, tell: Tell) -> None:
    """Publish a run from what is kept of it."""
    store, run, versions = before.store, before.run, before.versions
    if versions is None:
        words = f"run {run} does not tell its versions: runs/{run}/run.json is gone"
        raise Unkept(f"{words}; {REMEDY}")
    for name in SUBJECT:
        for _ in runs.each_part(store, run, name):
            pass  # each is there, and whole
    for path in gone(before, versions):
        raise Unkept(f"run {run} can't be shown: {path} is gone; {REMEDY}")
    told = {"title": str(before.told.get("title", "")), "anchors": anchors(before)}
    for doubt in site.publish(store, run, versions, **told):
        tell("warning", f"warning: {doubt}", warning=doubt)


def gone(before: Published, versions: Versions) -> Iterator[str]:
    """Name the models and small pictures of a run that are not there any more."""
    models, small = versions.folder("block"), versions.folder("thumbnail")
    kept = {folder: before.store.listed(folder) for folder in (models, small)}
    for table in before.parts("blocks", "model"):
        for path in table.column("model").to_pylist():
            if not kept[models].has(stem(path)):
                yield path
    without = undecoded(before)
    for table in before.parts("photos", "name", "sha256"):
        for row in table.to_pylist():
            key = versions.thumbnail_key(row["sha256"])
            if row["name"] not in without and not kept[small].has(key):
                yield versions.path("thumbnail", key)


def stem(path: str) -> str:
    """Give an artifact's key."""
    return path.rpartition("/")[2].removesuffix(".parquet")


def undecoded(before: Published) -> set[str]:
    """Name the photographs of which there never was a small picture."""
    found: set[str] = set()
    for table in before.parts("rejections", "key", "stage"):
        rows = table.to_pylist()
        found |= {row["key"] for row in rows if row["stage"] in UNDECODED}
    return found


def anchors(before: Published) -> index.Anchors:
    """Read where a run was told that its blocks lie: from its folder, or the city's.

    Raises:
        Unkept: if neither is what it was told.
    """
    store, run = before.store, before.run
    told = before.told.get("places", "")
    if not told:
        return index.Anchors()
    blocks = {
        asked.block_of(row) for row in asked.rows(store, run) if isinstance(row, Row)
    }
    for root in (f"{store.root}/runs/{run}", store.root):
        found = index.load(Store(root), sorted(blocks, key=natural))
        if found.sha256 == told:
            return found
    raise Unkept(f"run {run} can't be shown: its places are gone; {REMEDY}")
