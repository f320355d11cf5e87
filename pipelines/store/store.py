"""Artifacts: what a stage made of a photo or facade, kept under a key of its making.

    CITY/artifacts/<stage>/<stage version>/<first two hex digits>/<key>.parquet

The key is a hash of the keys of what it was made from and of the stage's version, so an
artifact is never wrong, only unused: it is skipped where it exists, and a changed stage
makes new ones beside the old. It is written to the disk under another name and then
moved, so that neither a killed run nor a power cut leaves half of one; one that was
damaged later is found out when it is read (`seal`). A rejection is an artifact too.
"""

import contextlib
import errno
import functools
import os
import uuid
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Any, Final

import pyarrow as pa
import pyarrow.fs as pafs
import pyarrow.parquet as pq

from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.store import disk, seal, tables
from pipelines.store.disk import worded
from pipelines.store.seal import Damaged
from pipelines.store.shelf import ARTIFACT, Place, Shelf, shelf

ARTIFACTS: Final = "artifacts"
VERDICT: Final = b"nostalgin.verdict"
MADE: Final = b"made"
REJECTED: Final = b"rejected"


@dataclass(frozen=True)
class Store:
    """A city folder, on this machine or wherever Arrow's file systems reach."""

    root: str  # a path, or a URI such as s3://bucket/city
    era: str = field(default="", compare=False)  # within one, listings are kept

    def _open(self) -> tuple[pafs.FileSystem, str]:
        """Find the file system.

        Raises:
            OSError: if the URI names none, or is no text.
        """
        if not disk.textual(self.root):
            shown = os.fsencode(self.root).decode(errors="backslashreplace")
            raise OSError(errno.EILSEQ, f"{shown} is not UTF-8", self.root)
        if disk.secretive(self.root):
            scheme = self.root.partition("://")[0]
            raise OSError(errno.EINVAL, disk.SECRETIVE, f"{scheme}://")
        local = "://" not in self.root
        where = os.path.abspath(self.root) if local else self.root  # noqa: PTH100
        try:
            return disk.reached(where, os.getpid())
        except pa.ArrowInvalid as problem:
            raise OSError(errno.EINVAL, str(problem), self.root) from problem

    @worded()
    def exists(self, name: str) -> bool:
        """Tell whether a file is there."""
        system, root = self._open()
        return system.get_file_info(f"{root}/{name}").type == pafs.FileType.File

    @worded()
    def stamps(self, names: Sequence[str]) -> list[tuple[int, int] | None]:
        """Tell the sizes of files and when they were changed, in nanoseconds.

        None of what is no file; an OSError if nobody can look, as without a network.
        """
        system, root = self._open()
        paths = [f"{root}/{name}" for name in names]
        try:
            told = system.get_file_info(paths)
        except (OSError, ValueError) as problem:  # one spoils all: ask for each
            if len(names) == 1:
                if disk.absent(problem):
                    return [None]
                raise
            return [stamp for name in names for stamp in self.stamps([name])]
        return [(one.size, one.mtime_ns) if one.is_file else None for one in told]

    @worded()
    def read_bytes(self, name: str, most: int = bounded.PHOTO_BYTES) -> bytes:
        """Read a whole file of at most so many bytes.

        Raises:
            FileNotFoundError: if there is none.
            OSError: if it is larger, or no regular file.
        """
        system, root = self._open()
        if isinstance(system, pafs.LocalFileSystem):
            return bounded.read(f"{root}/{name}", most)
        with system.open_input_file(f"{root}/{name}") as file:
            bounded.fits(file.size(), most, f"{self.root}/{name}")
            return file.read()

    @worded()
    def write_bytes(self, name: str, data: bytes) -> None:
        """Write a file so that it is there wholly or not at all.

        An object store shows nothing of an object before it is whole: there it is
        written under its own name, by one request where it fits into one.
        """
        system, root = self._open()
        target = f"{root}/{name}"
        if not isinstance(system, pafs.LocalFileSystem):
            with system.open_output_stream(target) as stream:
                stream.write(data)
            return
        system.create_dir(target.rpartition("/")[0], recursive=True)
        partial = f"{target}.{uuid.uuid4().hex[:8]}.partial"
        try:
            disk.durable(Path(partial), data)
            system.move(partial, target)
        except OSError:
            with contextlib.suppress(OSError):  # a full disk need not keep a torn file
                system.delete_file(partial)
            raise

    @worded()
    def names(self, folder: str) -> list[str]:
        """Name the files in a folder; none where there is no folder."""
        system, root = self._open()
        at = pafs.FileSelector(f"{root}/{folder}", allow_not_found=True)
        return sorted(one.base_name for one in system.get_file_info(at))

    def drop_folder(self, name: str) -> None:
        """Remove a folder, and those it lies in, as far as they are empty."""
        with contextlib.suppress(OSError):
            for one in (name, *map(str, PurePosixPath(name).parents[:-1])):
                Path(self.root, one).rmdir()  # an object store has none

    @worded()
    def drop_tree(self, name: str) -> None:
        """Remove a folder with all that is in it, if it is there."""
        system, root = self._open()
        disk.drop_tree(system, f"{root}/{name}")

    def drop(self, name: str) -> None:
        """Remove a file if it is there; from a pack, by writing it without."""
        self.remove(name)
        known = ARTIFACT.fullmatch(name)
        place = self.listed(known[1]).find(known[2]) if known else None
        if known and place is not None:
            from pipelines.store.packing import repack

            repack(self, known[1], place.pack, without={known[2]})
            remembered.cache_clear()

    @worded()
    def remove(self, name: str) -> None:
        """Remove a file if it is there."""
        system, root = self._open()
        with contextlib.suppress(FileNotFoundError):
            system.delete_file(f"{root}/{name}")

    @worded()
    def listed(self, folder: str) -> Shelf:
        """List the artifacts of a stage's version."""
        return shelf(*self._open(), folder)

    def _placed(self, name: str, *, anew: bool) -> tuple[str, Place] | None:
        known = ARTIFACT.fullmatch(name)
        if known is None or not (anew or self.era):
            return None
        folder, key = known.groups()
        near = self.root, folder, self.era, os.getpid()
        there = self.listed(folder) if anew else remembered(*near)
        place = there.find(key)
        return None if place is None else (folder, place)

    @worded()
    def cut(self, folder: str, place: Place) -> bytes:
        """Read an artifact's bytes out of a pack.

        Raises:
            FileNotFoundError: if the pack was written anew since.
        """
        system, root = self._open()
        with system.open_input_file(f"{root}/{folder}/{place.pack}") as file:
            return file.read_at(place.size, place.start)

    def write_table(self, name: str, table: pa.Table) -> None:
        """Write a table as sealed Parquet, wholly or not at all."""
        self.write_bytes(name, seal.sealed(table, name))

    def read_table(self, name: str, columns: Sequence[str] | None = None) -> pa.Table:
        """Read a table that `write_table` wrote, or some of its columns.

        Raises:
            FileNotFoundError: if there is none.
            Damaged: if it is not what was written.
        """
        return self._read(name, lambda artifact: seal.read(artifact, columns))

    def write_groups(
        self, name: str, schema: pa.Schema, groups: Iterable[pa.Table]
    ) -> None:
        """Write tables as the row groups of one file, holding one at a time."""
        self.write_bytes(name, seal.sealed_groups(schema, groups, name))

    def read_groups(
        self, name: str, span: tuple[int, int] | None = None
    ) -> Iterator[pa.Table]:
        """Read row groups one by one: all, or from a first to before another.

        Raises:
            FileNotFoundError: if there is no such file.
            Damaged: if it is not what was written.
        """
        system, root = self._open()
        with worded(), system.open_input_file(f"{root}/{name}") as file:
            try:
                artifact = seal.opened(file, name)
                for number in range(*(span or (0, artifact.num_row_groups))):
                    yield seal.read(artifact, groups=[number])
            except Damaged as problem:
                raise Damaged(problem.why, name) from problem

    def verdict(self, name: str) -> Rejection | bool:
        """Tell what an artifact holds: True if made, its rejection, False if absent.

        Its footer is looked at; a damaged page is found out where it is read.

        Raises:
            Damaged: if it is not what was written.
        """

        def told(artifact: pq.ParquetFile) -> Rejection | bool:
            if (artifact.schema_arrow.metadata or {}).get(VERDICT) != REJECTED:
                return True
            return tables.records(Rejection, seal.read(artifact))[0]

        found = self._placed(name, anew=False)
        if found is not None and not found[1].rejected:
            return True
        try:
            return self._read(name, told)
        except (FileNotFoundError, NotADirectoryError):
            return False
        except OSError:
            if self.exists(name):
                raise
            return False  # what lies there is no file

    @worded()
    def _read(self, name: str, told: Callable[[pq.ParquetFile], Any]) -> Any:
        found = self._placed(name, anew=False)
        if found is not None:
            with contextlib.suppress(FileNotFoundError):
                return self._told(pa.BufferReader(self.cut(*found)), name, told)
        system, root = self._open()
        try:
            with system.open_input_file(f"{root}/{name}") as file:
                return self._told(file, name, told)
        except FileNotFoundError:
            found = self._placed(name, anew=True)
            if found is None:
                raise
        return self._told(pa.BufferReader(self.cut(*found)), name, told)

    def _told(
        self, file: pa.NativeFile, name: str, told: Callable[[pq.ParquetFile], Any]
    ) -> Any:
        try:
            return told(seal.opened(file, name))
        except Damaged as problem:
            raise Damaged(problem.why, name) from problem

    def keep(self, name: str, made: pa.Table | Rejection) -> None:
        """Write an artifact: rows that were made, or the rejection in their place.

        Raises:
            Unstored: if it can't be written there, as on a full disk.
        """
        rejected = isinstance(made, Rejection)
        table = tables.table(Rejection, [made]) if rejected else made
        mark = {VERDICT: REJECTED if rejected else MADE}
        marked = table.replace_schema_metadata(
            {**(table.schema.metadata or {}), **mark}
        )
        try:
            self.write_table(name, marked)
        except OSError as problem:
            raise disk.Unstored(f"{name}: {problem}") from problem


@functools.lru_cache(maxsize=64)
def remembered(root: str, folder: str, era: str, process: int) -> Shelf:
    """List the artifacts of a stage's version once in an era, in each process."""
    del era, process
    return Store(root).listed(folder)
