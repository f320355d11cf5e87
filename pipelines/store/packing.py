"""Small artifacts become few large files, and nothing is lost on the way.

A pack is written before what it holds is removed, so that a process that is killed
leaves an artifact twice and never not at all.
"""

import contextlib
import math
import os
from collections.abc import Collection, Iterator
from typing import Final, NamedTuple

import pyarrow as pa

from pipelines.store import seal
from pipelines.store.seal import Damaged
from pipelines.store.shelf import PACKS, Entry, packed
from pipelines.store.stable import key_of
from pipelines.store.store import REJECTED, VERDICT, Store, remembered

PACK_BYTES: Final = 32_000_000  # a worker holds a few of these
PACK_COUNT: Final = 4096
LEAST: Final = 64  # artifacts that are worth a pack
FOLDERS: Final = 256  # in which the artifacts of a stage lie about


class Piece(NamedTuple):
    """What one process packs: some of what lies about in the folder of a stage."""

    folder: str
    part: int = 0  # by the first two digits of the keys
    parts: int = 1

    def has(self, key: str) -> bool:
        """Tell whether an artifact is in it."""
        return int(key[:2], 16) * self.parts // FOLDERS == self.part


def pieces(store: Store, folder: str) -> list[Piece]:
    """Part what is worth packing into pieces of some `PACK_COUNT` artifacts."""
    loose = len(store.listed(folder).loose)
    if loose < LEAST:
        return []
    parts = min(math.ceil(loose / PACK_COUNT), FOLDERS)
    return [Piece(folder, part, parts) for part in range(parts)]


def pack(store: Store, folder: str) -> int:
    """Pack what lies about in the folder of a stage's version, and tell how much."""
    return sum(pack_piece(store, one) for one in pieces(store, folder))


def pack_piece(store: Store, piece: Piece) -> int:
    """Pack a piece, and tell how much it was; one pack is held at a time.

    What is damaged is left: whoever needs it finds out, and makes it again. Of a store
    that remembers listings a process lists each folder once, for all its pieces.
    """
    folder, known = piece.folder, store.era
    there = remembered(store.root, folder, known, os.getpid()) if known else None
    there = there or store.listed(folder)
    loose = sorted(filter(piece.has, there.loose))
    twice = [key for key in loose if there.find(key) is not None]
    for key in twice:  # a process was killed in between
        remove(store, folder, key)
    done = 0
    for entries in bundles(read(store, folder, set(loose) - set(twice))):
        write(store, folder, entries)
        done += len(entries)
    return done


def bundles(entries: Iterator[Entry]) -> Iterator[list[Entry]]:
    """Part artifacts into packs."""
    bundle: list[Entry] = []
    size = 0
    for one in entries:
        bundle.append(one)
        size += len(one.data)
        if size >= PACK_BYTES or len(bundle) == PACK_COUNT:
            yield bundle
            bundle, size = [], 0
    if bundle:
        yield bundle


def read(store: Store, folder: str, keys: Collection[str]) -> Iterator[Entry]:
    """Read artifacts as they lie there, in the order of their keys."""
    for key in sorted(keys):
        name = artifact(folder, key)
        with contextlib.suppress(Damaged, FileNotFoundError):
            data = store.read_bytes(name)
            told = seal.opened(pa.BufferReader(data), name).schema_arrow.metadata or {}
            yield Entry(key, told.get(VERDICT) == REJECTED, data)


def write(store: Store, folder: str, entries: list[Entry]) -> None:
    """Write a pack, and remove what it holds from where it lay about."""
    told = key_of(*(one.key for one in entries))[:16]
    name = f"{folder}/{PACKS}/{len(entries)}-{told}.parquet"
    store.write_bytes(name, packed(entries, name))
    for one in entries:
        remove(store, folder, one.key)


def repack(store: Store, folder: str, which: str, *, without: Collection[str]) -> None:
    """Write a pack anew without some of its artifacts."""
    there = store.listed(folder)
    places = {key: there.find(key) for key in there.packed(which) if key not in without}
    kept = [
        Entry(key, one.rejected, store.cut(folder, one))
        for key, one in places.items()
        if one is not None and one.pack == which
    ]
    if kept:
        write(store, folder, kept)
    store.remove(f"{folder}/{which}")


def remove(store: Store, folder: str, key: str) -> None:
    """Remove an artifact that lies about."""
    store.remove(artifact(folder, key))


def artifact(folder: str, key: str) -> str:
    """Name an artifact that lies about, relative to the city folder."""
    return f"{folder}/{key[:2]}/{key}.parquet"
