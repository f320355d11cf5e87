"""Names of a site's files: harmless whatever they are of, and by content."""

import hashlib
import re
from collections.abc import Callable
from typing import Final

SUFFIXES: Final = ((b"\xff\xd8\xff", ".jpg"), (b"\x89PNG\r\n\x1a\n", ".png"))
NAMELESS: Final = "other"  # what has no harmless letters, as a street in Kyoto
CONTENT: Final = re.compile(r"(?:records|finder)/.+-([0-9a-f]{8})\.json")

Data = bytes | Callable[[], bytes]  # or how to read it, one file at a time


def digest(data: Data, sha256: str = "") -> str:
    """Give a file's name what changes with its content."""
    return (sha256 or hashlib.sha256(content(data)).hexdigest())[:8]


def altered(name: str, data: bytes) -> bool:
    """Tell whether a record or a list is not what its name was made from."""
    told = CONTENT.fullmatch(name)
    return told is not None and told[1] != digest(data)


def content(data: Data) -> bytes:
    """Give what stands in a file, which may have to be read first."""
    return data() if callable(data) else data


def safe(name: str) -> str:
    """Turn any name into a file name; different names give different ones.

    A harmless name stays as it is; another keeps its harmless letters and gets its
    hash. None begins with a dot or a line, which hosts of sites leave out.
    """
    if re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}", name):
        return name
    letters = re.sub(r"[^A-Za-z0-9_-]+", "-", name).strip("-_")[:40] or NAMELESS
    # a dot is in no harmless name, so that no other name can pose as this one
    return f"{letters}.{hashlib.sha256(name.encode()).hexdigest()[:12]}"


def suffix(data: bytes) -> str:
    """Tell a picture's file suffix by its first bytes."""
    if data[:4] == b"RIFF" and data[8:12] == b"WEBP":
        return ".webp"
    return next((end for start, end in SUFFIXES if data.startswith(start)), ".bin")
