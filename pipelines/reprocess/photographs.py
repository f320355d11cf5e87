"""What became of the photographs that a run has read: files, and what was made of them.

A file is unchanged if its size and the time of its last change are. Where these leave
a doubt its bytes are hashed: the time is another, or so late that the run may have read
the file before it.
"""

import errno
import hashlib
from collections import Counter, defaultdict
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np
import pyarrow as pa

from pipelines.index.asked import short
from pipelines.index.manifest import Unusable
from pipelines.index.roots import rooted
from pipelines.reprocess.now import Now
from pipelines.reprocess.published import Published
from pipelines.reprocess.verdicts import SMALL, STAGES
from pipelines.store import Damaged, Shelf, Store, absent
from pipelines.store.versions import Versions

SLACK_NS: Final = 2_000_000_000  # by which clocks of machines and disks may differ
Stamp = tuple[int, int]  # bytes, nanoseconds


class Fate(NamedTuple):
    """What became of one photograph."""

    id: int
    name: int
    cause: str  # "": it is as it was
    since_ns: int = 0  # when its file was changed


class Content(NamedTuple):
    """What a photograph's artifacts are made from."""

    sha256: str
    outline: str = ""
    quad: str = ""


def key(versions: Versions, stage: str, one: Content) -> str:
    """Key what a stage makes of a photograph."""
    drawn = {"matte": (one.outline,), "rectify": (one.outline, one.quad)}
    return getattr(versions, f"{stage}_key")(one.sha256, *drawn.get(stage, ()))


class Shelves(NamedTuple):
    """What is kept of each stage, at the versions of now."""

    of: dict[str, Shelf]
    made: Counter[str]  # what is found to be missing, by stage
    spoiled: list[str]  # paths of what is damaged
    store: Store | None  # where all is opened to see whether it is damaged

    def lacks(self, stage: str, paths: Sequence[str]) -> np.ndarray:
        """Tell of artifacts which are missing, or damaged."""
        keys = [path.rpartition("/")[2].removesuffix(".parquet") for path in paths]
        lacking = self.of[stage].lacks(keys)
        for at in np.flatnonzero(~lacking).tolist() if self.store else ():
            if not sound(self.store, paths[at]):
                self.spoiled.append(paths[at])
                lacking[at] = True
        return lacking


def sound(store: Store | None, path: str) -> bool:
    """Tell whether an artifact is what was written, to its last page."""
    try:
        return store is None or store.read_table(path) is not None
    except (Damaged, OSError):
        return False


def shelves(store: Store, versions: Versions, *, thorough: bool = False) -> Shelves:
    """List what is kept, a listing a stage; `thorough`, it is all read as well."""
    of = {stage: store.listed(versions.folder(stage)) for stage in vars(versions)}
    return Shelves(of, Counter(), [], store if thorough else None)


def fates(
    now: Now,
    before: Published,
    asked: np.ndarray,
    kept: Shelves,
    reached: Mapping[int, int],
    *,
    thorough: bool = False,
) -> Iterator[Fate]:
    """Tell what became of each photograph that a run has read, part by part.

    `asked` are the photographs that are asked for now; of those whose rejection stands
    `reached` tells how many stages they passed.
    """
    stamps = before.parts("stamps", "name", "root", "size", "mtime_ns")
    doubtful_ns = before.began_ns - SLACK_NS
    for photos in before.parts("photos", "name", "root", "sha256"):
        told = stamped(next(stamps, None))
        rows = list(zip(*(photos.column(n).to_pylist() for n in range(3)), strict=True))
        still = np.isin(np.array([short(r, n) for n, r, _ in rows], np.uint64), asked)
        there = present(rows, still)
        same: list[tuple[Fate, Content]] = []
        for (name, root, sha256), one, wanted in zip(rows, there, still, strict=True):
            fate = Fate(short(root, name), short(name), "")
            if not wanted or one is None:
                yield fate._replace(cause="removed")
                continue
            known = told.get((root, name))
            sure = known == one and one[1] < doubtful_ns and not thorough
            if sure or hashed(root, name) == sha256:
                same.append((fate, Content(sha256, *now.mended.drawn_on(name))))
            else:
                yield fate._replace(cause="changed", since_ns=one[1])
        yield from made(same, kept, now.versions, before.versions, reached)


def stamped(table: pa.Table | None) -> dict[tuple[str, str], Stamp]:
    """Read the stamps of one part by root and name."""
    if table is None:
        return {}
    name, root, size, mtime = (table.column(n).to_pylist() for n in range(4))
    return dict(
        zip(zip(root, name, strict=True), zip(size, mtime, strict=True), strict=True)
    )


def present(
    rows: Sequence[tuple[str, str, str]], wanted: np.ndarray | None = None
) -> list[Stamp | None]:
    """Look at the files of photographs, or of those wanted, a root's at once."""
    by_root: dict[str, list[int]] = defaultdict(list)
    for at, (_, root, _) in enumerate(rows):
        if wanted is None or wanted[at]:
            by_root[root].append(at)
    found: list[Stamp | None] = [None] * len(rows)
    for root, places in by_root.items():
        stamps = stamps_of(root, [rows[at][0] for at in places])
        for at, one in zip(places, stamps, strict=True):
            found[at] = one
    return found


class Unreached(Unusable):
    """Photographs that nobody can look at now: they are not gone for that."""

    def __init__(self, root: str, problem: OSError) -> None:
        """Say whose, and what to do."""
        why = problem.strerror or str(problem)
        super().__init__(
            f"{root} can't be reached: {why}; the city stays: mend network, disk or "
            "rights, and run it again, or take its rows out of the manifest"
        )


def stamps_of(root: str, names: Sequence[str]) -> list[Stamp | None]:
    """Look at files below a root; one that is not there has none.

    Raises:
        Unreached: if nobody can look.
    """
    try:
        return Store(root).stamps(names)
    except ValueError:
        return [None] * len(names)
    except OSError as problem:
        if absent(problem):
            return [None] * len(names)
        raise Unreached(root, problem) from problem


def hashed(root: str, name: str) -> str:
    """Hash a photograph's bytes; "" if there are none, or more than are read.

    Raises:
        Unreached: if nobody can look.
    """
    try:
        return hashlib.sha256(Store(root).read_bytes(name)).hexdigest()
    except ValueError:
        return ""
    except OSError as problem:
        if absent(problem) or problem.errno == errno.EFBIG:
            return ""
        raise Unreached(root, problem) from problem


def made(
    same: Sequence[tuple[Fate, Content]],
    kept: Shelves,
    versions: Versions,
    before: Versions | None,
    reached: Mapping[int, int],
) -> Iterator[Fate]:
    """Tell what is missing of what was made of photographs.

    Of one that a stage has rejected nothing is expected of that stage, whose verdict
    stands, as long as its version does.
    """
    changed = [
        s for s in (*STAGES, SMALL) if getattr(before, s, "") != getattr(versions, s)
    ]
    lacking = np.zeros(len(same), bool)
    for place, stage in enumerate((*STAGES, SMALL)):
        newer = [one for one in STAGES[: place + 1] if one in changed]
        passed = np.array(
            [wanted(place, reached.get(fate.name), bool(newer)) for fate, _ in same],
            bool,
        )
        paths = [versions.path(stage, key(versions, stage, one)) for _, one in same]
        missing = kept.lacks(stage, paths) & passed
        kept.made[stage] += int(missing.sum())
        lacking |= missing
    cause = "version" if changed else "missing"
    for (fate, _), lacks in zip(same, lacking, strict=True):
        yield fate._replace(cause=cause) if lacks else fate


def wanted(place: int, reached: int | None, newer: bool) -> bool:  # noqa: FBT001
    """Tell whether a stage's artifact of a photograph is expected to be there.

    `reached` is the stage that rejected it; a thumbnail is there of what was decoded,
    unless that is what was rejected.
    """
    if reached is None:
        return True
    if place == len(STAGES):
        return 0 < reached < len(STAGES)
    return place < reached or (newer and place == reached)


def fresh(
    tables: Iterable[pa.Table],
    city: str,
    unread: np.ndarray,
    refused: Container[int] = frozenset(),
) -> Iterator[Fate]:
    """Tell which photographs that no run has read are there to be read, each once.

    `unread` are the photographs that are asked for and were not read, sorted. Of names
    that the run has `refused` one is tried: it is new if it can be read by now.
    """
    told = np.zeros(len(unread), bool)
    for table in tables if len(unread) else ():
        usable = table.filter(table.column("reason").is_null())
        cells = (usable.column(name).to_pylist() for name in ("photo", "root"))
        rows = [(n, rooted(r, city)) for n, r in zip(*cells, strict=True) if n]
        found = {short(root, name): (name, root, "") for name, root in rows}
        ids = np.array(sorted(found), np.uint64)
        at = np.searchsorted(unread, ids).clip(max=len(unread) - 1)
        mine = (unread[at] == ids) & ~told[at]
        told[at[mine]] = True
        wanted_rows = [found[one] for one in ids[mine].tolist()]
        for (name, root, _), one in zip(wanted_rows, present(wanted_rows), strict=True):
            known = short(name) in refused
            if one is not None and not (known and unreadable(root, name)):
                yield Fate(short(root, name), short(name), "new", one[1])


def unreadable(root: str, name: str) -> bool:
    """Tell whether a file that is there can't be read, as a run would read it."""
    try:
        Store(root).read_bytes(name)
    except (OSError, ValueError):
        return True
    return False
