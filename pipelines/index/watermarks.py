"""The watermarks of archives that are known: a small file each, beside the profiles.

A file holds what one tile covers and adds, what it says, and its steps, as
`nostalgin watermark` learns them; an archive's own lies in its city's folder. It is
data of ours alone: no pixel of a photograph is in it.
"""

import hashlib
import io
import zipfile
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np

from nostalgin_core.rectify import Watermark

ARCHIVES: Final = Path(__file__).with_name("archives")
SUFFIX: Final = ".npz"
OWN: Final = "watermark.npz"  # in a city folder: the archive's own
BLANK: Final = np.zeros((1, 1), np.float32)
PLAIN: Final = Watermark("", BLANK, BLANK, (1.0, 1.0))
USUAL: Final = PLAIN.from_top, PLAIN.wide_px, PLAIN.near_px  # need not be told
WIDEST_PX: Final = 10_000
MOST_BYTES: Final = 64_000_000  # of a file, unpacked


def known() -> list[str]:
    """Name the watermarks that come with the program."""
    return sorted(path.stem for path in ARCHIVES.glob(f"*{SUFFIX}"))


@lru_cache
def watermark(name: str) -> Watermark | None:
    """Load a watermark that comes with the program; none by an empty name."""
    return loaded(content(name))


def content(name: str) -> bytes:
    """Read the file of one that comes with the program; nothing by an empty name."""
    return (ARCHIVES / f"{name}{SUFFIX}").read_bytes() if name else b""


@lru_cache(maxsize=4)
def loaded(data: bytes) -> Watermark | None:
    """Load a watermark's file; none of nothing."""
    return read(data) if data else None


def sha256(data: bytes) -> str:
    """Hash a watermark, so that what it was taken out of can be told; "" of none."""
    return hashlib.sha256(data).hexdigest() if data else ""


def own(data: bytes) -> bytes:
    """Insist on a file that `written` wrote.

    Raises:
        ValueError: if it is none.
    """
    try:
        fits(data)
        mark = read(data)
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as problem:
        raise ValueError("no watermark that `nostalgin watermark` wrote") from problem
    tiles, told = (mark.covers, mark.adds), (*mark.step, mark.from_top, mark.near_px)
    sound = all(one.ndim == 2 and np.isfinite(one).all() for one in (*tiles,))
    sound = sound and mark.covers.shape == mark.adds.shape and mark.covers.size > 0
    if not (sound and np.isfinite(told).all() and min(mark.step) > 0):
        raise ValueError("a watermark of no sense: learn it anew")
    if np.abs(mark.covers).max() >= 1 or not 0 < mark.wide_px <= WIDEST_PX:
        raise ValueError("a watermark of no sense: learn it anew")
    return data


def fits(data: bytes) -> None:
    """Refuse a file that unpacks to more than a tile has.

    Raises:
        ValueError: if it does.
    """
    with zipfile.ZipFile(io.BytesIO(data)) as held:
        size = sum(one.file_size for one in held.infolist())
    if size > MOST_BYTES:
        raise ValueError(f"{size:,} bytes unpacked; a tile has fewer")


def read(data: bytes) -> Watermark:
    """Read what `written` wrote."""
    with np.load(io.BytesIO(data), allow_pickle=False) as held:
        across, down = (float(one) for one in held["step"])
        covers, adds = (held[name].astype(np.float32) for name in ("covers", "adds"))
        mark = Watermark(str(held["words"]), covers, adds, (across, down))
        if "told" not in held:  # New York's
            return mark
        from_top, wide_px, near_px = (float(one) for one in held["told"])
    return replace(mark, from_top=from_top, wide_px=int(wide_px), near_px=near_px)


def written(mark: Watermark) -> bytes:
    """Write a watermark, the same bytes for the same."""
    out = io.BytesIO()
    told = (mark.from_top, mark.wide_px, mark.near_px)
    held = {
        "words": np.array(mark.words),
        "covers": mark.covers.astype(np.float16),
        "adds": mark.adds.astype(np.float16),
        "step": np.array(mark.step),
    }
    if told != USUAL:
        held["told"] = np.array(told)
    np.savez_compressed(out, allow_pickle=False, **held)
    return out.getvalue()
