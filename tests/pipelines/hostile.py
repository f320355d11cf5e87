"""Files that have no end, or claim none that a machine could hold."""

import os
from pathlib import Path


def hostile(path: Path, kind: str) -> Path:
    """Put a pipe, a link to a device without an end, or 3 GB of holes at a path."""
    path.unlink(missing_ok=True)
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "device":
        path.symlink_to("/dev/zero")
    else:
        with path.open("wb") as file:
            file.truncate(3_000_000_000)
    return path
