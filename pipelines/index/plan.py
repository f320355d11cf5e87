"""What a manifest asks for: photos to work on, and blocks to build from them.

`plan` is the plain form of what the pipeline does with rows that no process holds.
"""

import hashlib
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from nostalgin_core.records import Front, Rejection
from pipelines.index.roots import rooted
from pipelines.index.row import Row

Name = tuple[str, str]  # a photo's root and its path below


@dataclass(frozen=True)
class PhotoRef:
    """A photo in the archive, by name; by content once it was read."""

    root: str  # the folder that names are relative to
    name: str
    blocks: tuple[str, ...]  # that it may show fronts of
    sha256: str = ""
    # As its file was before it was read; of an element's name they are no part.
    size: int = field(default=0, repr=False, compare=False)
    mtime_ns: int = field(default=0, repr=False, compare=False)
    outline: str = ""  # of its front, if somebody drew it: x,y x,y ... in its pixels
    quad: str = ""  # of its front, the same

    @property
    def key(self) -> str:
        """Name the photo in rejections."""
        return self.name

    @property
    def drawn(self) -> tuple[str, str]:
        """Give what its artifacts are made from beside its content."""
        return self.outline, self.quad


@dataclass(frozen=True)
class BlockTask:
    """One block: its fronts, and which photos may show them."""

    block: str
    fronts: tuple[Front, ...]  # in the order of ring and rank
    photos: tuple[tuple[Name, str], ...]  # and a front that each may show
    credit: str
    licence: str = ""
    sources: tuple[str, ...] = ()  # addresses of the archive's records
    # What is told of each photo: credit, rights, licence, date, where any is.
    told: tuple[tuple[Name, tuple[tuple[str, str], ...]], ...] = ()
    heights_m: tuple[tuple[str, float], ...] = ()  # that are known, by building
    targets_px: tuple[tuple[Name, float], ...] = ()  # x of the facade that is meant
    widths_m: tuple[tuple[str, float], ...] = ()  # of streets that cut it, as told

    @property
    def key(self) -> str:
        """Name the block in rejections."""
        return self.block


@dataclass(frozen=True)
class Plan:
    """All there is to do, in order, and what can't be done."""

    photos: tuple[PhotoRef, ...]
    blocks: tuple[BlockTask, ...]
    rejections: tuple[Rejection, ...]


def plan(rows: Sequence[Row], *, city: str, shard: tuple[int, int] = (1, 1)) -> Plan:
    """Sort the manifest's rows into photos and blocks, and take one part of the blocks.

    A photo without a front is rejected: there is no place for it.
    """
    blocks = defaultdict(list)
    photos: dict[Name, list[str]] = defaultdict(list)
    for row in rows:
        if row.front is None or not falls_to(row.front.block, shard):
            continue
        blocks[row.front.block].append(row)
        if row.photo:
            photos[rooted(row.root, city), row.photo].append(row.front.block)
    return Plan(
        tuple(photo_ref(one, theirs) for one, theirs in sorted(photos.items())),
        tuple(
            block_task(block, theirs, city=city)
            for block, theirs in sorted(blocks.items())
        ),
        tuple(homeless(row) for row in rows if row.front is None),
    )


def photo_ref(photo: Name, blocks: Iterable[str]) -> PhotoRef:
    """Name a photo with the blocks that it may show."""
    return PhotoRef(*photo, tuple(sorted(set(blocks))))


def block_task(block: str, rows: Sequence[Row], *, city: str) -> BlockTask:
    """Gather one block's fronts; a front in several rows counts once, as first told."""
    fronts: dict[str, Front] = {}
    for row in rows:
        if row.front is not None:
            fronts.setdefault(row.front.front_id, row.front)
    ordered = sorted(
        fronts.values(), key=lambda one: (one.ring, one.rank, one.front_id)
    )
    pairs = {
        ((rooted(row.root, city), row.photo), row.front.front_id)
        for row in rows
        if row.photo and row.front
    }
    told: dict[Name, dict[str, str]] = {}
    for row in rows:
        if row.photo and row.told:
            words = {"credit": row.credit} if row.credit else {}
            told.setdefault((rooted(row.root, city), row.photo), words | row.told)
    facts = sorted((name, tuple(sorted(own.items()))) for name, own in told.items())
    return BlockTask(
        block,
        tuple(ordered),
        tuple(sorted(pairs)),
        credit="; ".join(sorted({row.credit for row in rows if row.credit})),
        licence="; ".join(sorted({row.licence for row in rows if row.licence})),
        sources=tuple(sorted({row.source for row in rows if row.source})),
        told=tuple(facts),
    )


def homeless(row: Row) -> Rejection:
    """Tell that a photo can't be placed, and how to give it a place."""
    detail = f"{row.key}: fill in front_id, block and lot of {row.photo}"
    return Rejection(row.photo, "manifest", "no front known", detail)


def falls_to(block: str, shard: tuple[int, int]) -> bool:
    """Tell whether a block is in the k-th of n parts, the same on every machine."""
    k, n = shard
    digest = hashlib.sha256(block.encode()).digest()
    return int.from_bytes(digest[:8], "big") % n == k - 1
