"""A file of this machine is read only if it is one, and to a size that is stated.

A pipe or a device has no end, and to open a pipe is to wait for whoever writes to it; a
file with holes claims more bytes than the machine has memory.
"""

import errno
import os
import stat
from pathlib import Path
from typing import Final

PHOTO_BYTES: Final = 1_000_000_000  # 150 megapixels of 16-bit RGB, as they are
TABLE_BYTES: Final = 250_000_000  # a list: a million rows of the New York archive's
NETWORK_BYTES: Final = 2_000_000_000  # ONNX's own limit
LOCK_BYTES: Final = 1_000_000
PROFILE_BYTES: Final = 64_000  # of an archive: some patterns
MARK_BYTES: Final = 16_000_000  # of a watermark: a tile of a million places
SLACK: Final = 1 << 20


def read(path: str | Path, most: int) -> bytes:
    """Read a regular file of at most so many bytes.

    Raises:
        OSError: if it is none, or larger, or can't be read; `strerror` says which.
    """
    # without O_NONBLOCK the opening of a pipe never ends
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    with os.fdopen(os.open(path, flags), "rb") as file:
        found = os.fstat(file.fileno())
        if stat.S_ISDIR(found.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        if not stat.S_ISREG(found.st_mode):
            raise OSError(errno.EINVAL, "Not a regular file", str(path))
        fits(found.st_size, most, str(path))
        # a file may grow, or tell no size; and room is made for all that is asked
        data = file.read(min(most, max(found.st_size, SLACK)) + 1)
        while len(data) <= most and (more := file.read(SLACK)):
            data += more
    fits(len(data), most, str(path))
    return data


def fits(size: int, most: int, name: str) -> None:
    """Refuse a file of more bytes than are read.

    Raises:
        OSError: if it has more.
    """
    if size > most:
        told = f"Larger than the {most:,} bytes that are read"
        raise OSError(errno.EFBIG, told, name)
