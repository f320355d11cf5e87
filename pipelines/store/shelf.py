"""Many artifacts in one file, found by one listing.

    CITY/artifacts/<stage>/<stage version>/packs/<count>-<hash of its keys>.parquet

A row holds the bytes of an artifact as they were, its key, and whether it is a
rejection. The bytes are one page, neither compressed again nor encoded, so that where
each begins follows from the sizes before it: one is read without the others.
"""

import io
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np
import pyarrow as pa
import pyarrow.fs as pafs
import pyarrow.parquet as pq

from pipelines.store import seal
from pipelines.store.seal import Damaged

PACKS: Final = "packs"
PACKED: Final = re.compile(rf"{PACKS}/(\d+)-[0-9a-f]+\.parquet")
LOOSE: Final = re.compile(r"[0-9a-f]{2}/([0-9a-f]{40})\.parquet")
ARTIFACT: Final = re.compile(
    r"(artifacts/[^/]+/[^/]+)/[0-9a-f]{2}/([0-9a-f]{40})\.parquet"
)
ONE_PAGE: Final = 1 << 30
LENGTH: Final = 4  # bytes that Parquet puts before each value
SCHEMA: Final = pa.schema(
    [
        pa.field("key", pa.string(), nullable=False),
        pa.field("rejected", pa.bool_(), nullable=False),
        pa.field("size", pa.int64(), nullable=False),
        pa.field("artifact", pa.large_binary(), nullable=False),
    ]
)
INDEX: Final = ["key", "rejected", "size"]


class Entry(NamedTuple):
    """An artifact to be packed."""

    key: str
    rejected: bool
    data: bytes


class Place(NamedTuple):
    """Where an artifact lies in a pack."""

    pack: str  # relative to the folder
    start: int
    size: int
    rejected: bool


def packed(entries: Sequence[Entry], name: str) -> bytes:
    """Encode artifacts as one sealed file of this name in the store."""
    columns = [
        [one.key for one in entries],
        [one.rejected for one in entries],
        [len(one.data) for one in entries],
        [one.data for one in entries],
    ]
    marked = SCHEMA.with_metadata({seal.SEAL: seal.ZEROS})
    sink = io.BytesIO()
    compression: Any = dict.fromkeys(INDEX, "zstd") | {"artifact": "none"}
    pq.write_table(
        pa.table(columns, schema=marked),
        sink,
        row_group_size=len(entries),
        compression=compression,
        use_dictionary=False,
        write_statistics=False,
        write_page_checksum=True,
        data_page_size=ONE_PAGE,
    )
    return seal.signed(sink.getvalue(), name)


@dataclass(frozen=True)
class Shelf:
    """What artifacts of one version of a stage there are, as one listing told."""

    loose: frozenset[str]  # keys
    packs: tuple[str, ...]
    broken: tuple[str, ...]  # packs whose index is damaged
    keys: np.ndarray  # of what is packed, sorted
    places: np.ndarray  # beside each: which pack, start, size, rejected

    def find(self, key: str) -> Place | None:
        """Tell where an artifact is packed, if it is."""
        at = int(np.searchsorted(self.keys, key.encode()))
        if at == len(self.keys) or self.keys[at] != key.encode():
            return None
        pack, start, size, rejected = map(int, self.places[at])
        return Place(self.packs[pack], start, size, bool(rejected))

    def has(self, key: str) -> bool:
        """Tell whether an artifact is there."""
        return key in self.loose or self.find(key) is not None

    def lacks(self, keys: Sequence[str]) -> np.ndarray:
        """Tell of each of many keys whether its artifact is missing."""
        asked = np.array(keys, "S40")
        if not len(asked):
            return np.zeros(0, bool)
        lacking = ~np.isin(asked, self.keys)
        for at in np.flatnonzero(lacking).tolist() if self.loose else ():
            lacking[at] = keys[at] not in self.loose
        return lacking

    def __iter__(self) -> Iterator[str]:
        """Name all artifacts once."""
        yield from self.loose
        yield from (one for one in self.packed() if one not in self.loose)

    def packed(self, pack: str = "") -> list[str]:
        """Name the artifacts of a pack, or of all."""
        mine = self.keys
        if pack:
            mine = mine[self.places[:, 0] == self.packs.index(pack)]
        return [one.decode() for one in mine]


def shelf(system: pafs.FileSystem, root: str, folder: str) -> Shelf:
    """List a stage's artifacts, and read the indexes of its packs."""
    top = f"{root}/{folder}"
    at = pafs.FileSelector(top, allow_not_found=True, recursive=True)
    try:
        found = [one.path for one in system.get_file_info(at) if one.is_file]
    except NotADirectoryError:  # who keeps something there will tell
        found = []
    names = sorted(path[len(top) + 1 :] for path in found)
    loose = (LOOSE.fullmatch(name) for name in names)
    packs = [name for name in names if PACKED.fullmatch(name)]
    keys, places, broken = [], [], []
    for number, name in enumerate(packs):
        try:
            with system.open_input_file(f"{top}/{name}") as file:
                told, where = index(file, f"{folder}/{name}")
        except (Damaged, FileNotFoundError):
            broken.append(name)
            continue
        keys.append(told)
        places.append(np.insert(where, 0, number, axis=1))
    whole = np.concatenate(keys) if keys else np.zeros(0, "S40")
    beside = np.concatenate(places) if places else np.zeros((0, 4), np.int64)
    order = np.argsort(whole, kind="stable")
    there = frozenset(one[1] for one in loose if one)
    return Shelf(there, tuple(packs), tuple(broken), whole[order], beside[order])


def index(file: pa.NativeFile, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Read what a pack holds: keys, and the start, size and verdict of each.

    Raises:
        Damaged: if it is not what was written.
    """
    artifact = seal.opened(file, name)
    table = seal.read(artifact, INDEX)
    sizes = table.column("size").to_numpy()
    chunk = artifact.metadata.row_group(0).column(len(INDEX))
    body = int(sizes.sum()) + LENGTH * len(sizes)
    begin = chunk.data_page_offset + chunk.total_compressed_size - body
    starts = begin + np.cumsum(sizes + LENGTH) - sizes
    rejected = table.column("rejected").to_numpy().astype(np.int64)
    keys = np.array(table.column("key").to_pylist(), "S40")
    return keys, np.stack([starts, sizes, rejected], axis=1)
