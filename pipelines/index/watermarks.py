"""The watermarks of archives that are known: a small file each, beside the profiles.

A file holds what one tile covers and adds, what it says, and its steps, as
`nostalgin evaluate watermark` measures them. It is data of ours alone: no pixel of a
photograph is in it.
"""

import hashlib
import io
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np

from nostalgin_core.rectify import Watermark

ARCHIVES: Final = Path(__file__).with_name("archives")
SUFFIX: Final = ".npz"


def known() -> list[str]:
    """Name the watermarks that come with the program."""
    return sorted(path.stem for path in ARCHIVES.glob(f"*{SUFFIX}"))


@lru_cache
def watermark(name: str) -> Watermark | None:
    """Load a watermark that comes with the program; none by an empty name."""
    return read(content(name)) if name else None


def sha256(name: str) -> str:
    """Hash a watermark, so that what it was taken out of can be told; "" of none."""
    return hashlib.sha256(content(name)).hexdigest() if name else ""


def content(name: str) -> bytes:
    """Read a watermark's file."""
    return (ARCHIVES / f"{name}{SUFFIX}").read_bytes()


def read(data: bytes) -> Watermark:
    """Read what `written` wrote."""
    with np.load(io.BytesIO(data), allow_pickle=False) as held:
        across, down = (float(one) for one in held["step"])
        covers, adds = (held[name].astype(np.float32) for name in ("covers", "adds"))
        return Watermark(str(held["words"]), covers, adds, (across, down))


def written(mark: Watermark) -> bytes:
    """Write a watermark, the same bytes for the same."""
    out = io.BytesIO()
    np.savez_compressed(
        out,
        words=np.array(mark.words),
        covers=mark.covers.astype(np.float16),
        adds=mark.adds.astype(np.float16),
        step=np.array(mark.step),
    )
    return out.getvalue()
