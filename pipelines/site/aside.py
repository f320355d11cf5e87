"""What is too much for a driver's memory is set down on the disk for a while.

The files have no names: they are gone with the process, however that ends.
"""

import contextlib
import json
import os
import tempfile
import zlib
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import IO, Any, Self

Json = dict[str, Any]


class Aside:
    """Bytes set down one after another, each read again when it is asked for."""

    def __init__(self, folder: Path) -> None:
        """Begin with none, on the disk of a folder."""
        folder.mkdir(parents=True, exist_ok=True)
        self._open = contextlib.ExitStack()
        self._file = self._open.enter_context(nameless(folder))

    def __enter__(self) -> Self:
        """Hold the disk's room."""
        return self

    def __exit__(self, *failure: object) -> None:
        """Give it back."""
        self._open.close()

    def put(self, data: bytes) -> Callable[[], bytes]:
        """Set bytes down, and tell how to read them."""
        start = self._file.seek(0, os.SEEK_END)
        self._file.write(data)
        return partial(self._read, start, len(data))

    def _read(self, start: int, size: int) -> bytes:
        self._file.seek(start)
        return self._file.read(size)


class Heaps:
    """Rows set down in so many heaps; those of one name lie in one, in their order."""

    def __init__(self, folder: Path, count: int) -> None:
        """Begin with none, on the disk of a folder."""
        self._open = contextlib.ExitStack()
        own = (self._open.enter_context(nameless(folder)) for _ in range(count))
        self._files = list(own)

    def __enter__(self) -> Self:
        """Hold the disk's room."""
        return self

    def __exit__(self, *failure: object) -> None:
        """Give it back."""
        self._open.close()

    def put(self, name: str, row: Json) -> None:
        """Set a row down in its name's heap."""
        told = zlib.crc32(name.encode(errors="surrogatepass"))
        file = self._files[told % len(self._files)]
        file.write(json.dumps(row).encode() + b"\n")

    def each(self) -> Iterator[list[Json]]:
        """Read heap by heap, holding one."""
        for file in self._files:
            file.seek(0)
            yield [json.loads(line) for line in file]


def nameless(folder: Path) -> IO[bytes]:
    """Open a file without a name."""
    return tempfile.TemporaryFile(dir=folder)
