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
import hashlib
import io
import os
import uuid
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import pyarrow as pa
import pyarrow.fs as pafs
import pyarrow.parquet as pq

from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.store import seal, tables
from pipelines.store.seal import Damaged

ARTIFACTS: Final = "artifacts"
VERDICT: Final = b"nostalgin.verdict"
MADE: Final = b"made"
REJECTED: Final = b"rejected"


class Unstored(BaseException):
    """What was made can't be put where it belongs; no photo's fault, it ends the run.

    It is no `Exception`, so that nothing that forgives a photo's crash forgives it.
    """


def key_of(*parts: str) -> str:
    """Hash parts into a key; ("ab", "c") and ("a", "bc") differ."""
    joined = "\0".join(parts).encode()
    return hashlib.sha256(joined).hexdigest()[:40]


def parquet_bytes(table: pa.Table) -> bytes:
    """Encode a table; the same rows give the same bytes."""
    sink = io.BytesIO()
    pq.write_table(
        table, sink, compression="zstd", use_dictionary=False, write_statistics=False
    )
    return sink.getvalue()


def textual(name: str) -> bool:
    """Tell whether a file's name is text; a file system takes any bytes."""
    return not any("\ud800" <= letter <= "\udfff" for letter in name)


def durable(path: Path, data: bytes) -> None:
    """Write a new file that is on the disk when this returns.

    Raises:
        FileExistsError: if there is one, or a link.
    """
    with path.open("xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())


@functools.lru_cache(maxsize=64)
def reached(where: str, process: int) -> tuple[pafs.FileSystem, str]:
    """Find the file system of a path or a URI, once in each process.

    An object store's has connections and threads, which no fork may share.
    """
    del process
    system, path = pafs.FileSystem.from_uri(where)
    return system, path.rstrip("/")


@dataclass(frozen=True)
class Store:
    """A city folder, on this machine or wherever Arrow's file systems reach."""

    root: str  # a path, or a URI such as s3://bucket/city

    def _open(self) -> tuple[pafs.FileSystem, str]:
        """Find the file system.

        Raises:
            OSError: if the URI names none, or is no text.
        """
        if not textual(self.root):
            shown = os.fsencode(self.root).decode(errors="backslashreplace")
            raise OSError(errno.EILSEQ, f"{shown} is not UTF-8", self.root)
        local = "://" not in self.root
        where = os.path.abspath(self.root) if local else self.root  # noqa: PTH100
        try:
            return reached(where, os.getpid())
        except pa.ArrowInvalid as problem:
            raise OSError(errno.EINVAL, str(problem), self.root) from problem

    def exists(self, name: str) -> bool:
        """Tell whether a file is there."""
        system, root = self._open()
        return system.get_file_info(f"{root}/{name}").type == pafs.FileType.File

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

    def write_bytes(self, name: str, data: bytes) -> None:
        """Write a file so that it is there wholly or not at all."""
        system, root = self._open()
        target = f"{root}/{name}"
        system.create_dir(target.rpartition("/")[0], recursive=True)
        partial = f"{target}.{uuid.uuid4().hex[:8]}.partial"
        try:
            if isinstance(system, pafs.LocalFileSystem):
                durable(Path(partial), data)
            else:
                with system.open_output_stream(partial) as stream:
                    stream.write(data)
            system.move(partial, target)
        except OSError:
            with contextlib.suppress(OSError):  # a full disk need not keep a torn file
                system.delete_file(partial)
            raise

    def names(self, folder: str) -> list[str]:
        """Name the files in a folder; none where there is no folder."""
        system, root = self._open()
        at = pafs.FileSelector(f"{root}/{folder}", allow_not_found=True)
        return sorted(one.base_name for one in system.get_file_info(at))

    def below(self, folder: str) -> list[str]:
        """Name all files below a folder by one listing, relative to it."""
        system, root = self._open()
        top = f"{root}/{folder}"
        at = pafs.FileSelector(top, allow_not_found=True, recursive=True)
        found = (one.path for one in system.get_file_info(at) if one.is_file)
        return sorted(path[len(top) + 1 :] for path in found)

    def drop(self, name: str) -> None:
        """Remove a file if it is there."""
        system, root = self._open()
        with contextlib.suppress(FileNotFoundError):
            system.delete_file(f"{root}/{name}")

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
        with system.open_input_file(f"{root}/{name}") as file:
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

        return self._read(name, told) if self.exists(name) else False

    def _read(self, name: str, told: Callable[[pq.ParquetFile], Any]) -> Any:
        system, root = self._open()
        with system.open_input_file(f"{root}/{name}") as file:
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
            raise Unstored(f"{name}: {problem}") from problem
