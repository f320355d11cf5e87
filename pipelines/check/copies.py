"""Photographs that are the same file, or look the same, under several names.

Files are the same by their SHA-256, looked at where their sizes are. Pictures look the
same where their perceptual hashes (64 bits of a discrete cosine transform) differ in
few bits: a scan that was saved anew, made smaller or brighter. What is told is always
a pair of names, of a photograph and the first that it is like; only a pair of different
lots is grave.
"""

import hashlib
from collections import defaultdict
from collections.abc import Iterator, Mapping
from itertools import pairwise
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from jaxtyping import Bool, UInt64

from nostalgin_core import photo
from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.check.finding import Finding

BITS: Final = 64
# Of 99 tax photographs any two differ in 8 bits or more; one saved anew at half its
# size differs from itself in 2 at most.
MOST_APART: Final = 6
BANDS: Final = MOST_APART + 1  # of which two such hashes share one at least
CHUNK: Final = 2048  # hashes of one band that are compared at once

Files = Mapping[str, Path]  # by the photograph's name in the manifest
Lots = Mapping[str, frozenset[str]]  # that each photograph shows


def same_files(files: Files, lots: Lots, rows: Mapping[str, str]) -> Iterator[Finding]:
    """Find files that are the same under several names."""
    sizes: dict[int, list[str]] = defaultdict(list)
    for name, path in sorted(files.items()):
        sizes[path.stat().st_size].append(name)
    for names in sizes.values():
        by_content: dict[str, list[str]] = defaultdict(list)
        for name in names if len(names) > 1 else ():
            data = bounded.read(files[name], bounded.PHOTO_BYTES)
            by_content[hashlib.sha256(data).hexdigest()].append(name)
        for first, *others in by_content.values():
            for other in others:
                yield pair("same file", first, other, lots, rows)


def alike(files: Files, lots: Lots, rows: Mapping[str, str]) -> Iterator[Finding]:
    """Find pictures that look the same, that lie on light paper, and that are none."""
    hashes: dict[str, int] = {}
    printed: list[str] = []
    for name, path in sorted(files.items()):
        found = looks(path, name)
        if isinstance(found, Rejection):
            words = f"{found.reason}: {found.detail}"
            remedy = "restore the file, or delete its rows"
            yield Finding("unreadable picture", rows[name], words, remedy, grave=True)
            continue
        if found.printed:
            printed.append(name)
        if found.paged:
            remedy = "save each of the others as a file, if it is a photograph"
            words = f"{name}: its first is read alone"
            yield Finding("several pages", rows[name], words, remedy, grave=False)
        if found.code is not None:
            hashes[name] = found.code
    if printed:
        words = f"{printed[0]}, one of {len(printed)}: its paper is cut off"
        remedy = "see that the picture is whole, as `nostalgin explain` shows it"
        yield Finding("light border", rows[printed[0]], words, remedy, grave=False)
    names = list(hashes)
    codes = np.array([hashes[name] for name in names], np.uint64)
    for a, b in likenesses(codes):
        if not same(files[names[a]], files[names[b]]):
            yield pair("looks the same", names[a], names[b], lots, rows)


def same(one: Path, other: Path) -> bool:
    """Tell whether two files are the same."""
    if one.stat().st_size != other.stat().st_size:
        return False
    a, b = (bounded.read(path, bounded.PHOTO_BYTES) for path in (one, other))
    return a == b


class Look(NamedTuple):
    """What a picture shows."""

    code: int | None  # the hash of what lies within its border; None if that is plain
    printed: bool  # on light paper
    paged: bool  # its file holds others, which are not looked at


def looks(path: Path, name: str) -> Look | Rejection:
    """Look at a picture within its border."""
    import imagehash
    from PIL import Image

    data = bounded.read(path, bounded.PHOTO_BYTES)
    picture = photo.decode(data, name=name)
    if isinstance(picture, Rejection):
        return picture
    x0, y0, x1, y1 = picture.frame
    inner = picture.image[y0:y1, x0:x1]
    told = {"printed": picture.sheet is not None, "paged": photo.paged(data)}
    if inner.size == 0 or inner.std() < 1.0:
        return Look(None, **told)
    return Look(bits(imagehash.phash(Image.fromarray(inner)).hash), **told)


def bits(hashed: Bool[np.ndarray, "8 8"]) -> int:
    """Write a hash as a number."""
    return int("".join("1" if bit else "0" for bit in hashed.ravel()), 2)


def likenesses(codes: UInt64[np.ndarray, " n"]) -> list[tuple[int, int]]:
    """Pair each hash with the first that it is like: of many alike few are told."""
    each, first, which = np.unique(codes, return_index=True, return_inverse=True)
    like = first.copy()
    for a, b in pairs(each):
        like[a], like[b] = min(like[a], first[b]), min(like[b], first[a])
    told = like[which]
    return [(int(told[at]), at) for at in range(len(codes)) if told[at] != at]


def pairs(codes: UInt64[np.ndarray, " n"]) -> list[tuple[int, int]]:
    """List the pairs of hashes that differ in few bits, each once, in order.

    Of `MOST_APART` differing bits one of `BANDS` parts is free, so that only hashes
    that share a part are compared.
    """
    found: set[tuple[int, int]] = set()
    edges = np.linspace(0, BITS, BANDS + 1).astype(int)
    for low, high in pairwise(edges):
        mask = np.uint64((1 << int(high - low)) - 1)
        part = (codes >> np.uint64(low)) & mask
        ordered = np.argsort(part, kind="stable")
        starts = np.flatnonzero(np.diff(part[ordered], prepend=np.uint64(2**63)))
        for group in np.split(ordered, starts[1:]) if len(codes) else ():
            found.update(near(group, codes))
    return sorted(found)


def near(
    group: np.ndarray, codes: UInt64[np.ndarray, " n"]
) -> Iterator[tuple[int, int]]:
    """Compare all hashes of one group."""
    for start in range(0, len(group), CHUNK):
        some = group[start : start + CHUNK]
        apart = np.bitwise_count(codes[some][:, None] ^ codes[group][None])
        for i, j in zip(*np.nonzero(apart <= MOST_APART), strict=True):
            a, b = int(some[i]), int(group[j])
            if a < b:
                yield a, b


def pair(kind: str, a: str, b: str, lots: Lots, rows: Mapping[str, str]) -> Finding:
    """Tell of two photographs; of one lot they may well be alike."""
    here, there = lots.get(a, frozenset()), lots.get(b, frozenset())
    shown = f"{b} as {a} ({rows[a]})"
    if here == there:
        return Finding(kind, rows[b], shown, "delete one of them", grave=False)
    words = f"{shown}, but {told(there)} and {told(here)}"
    remedy = "mend the lot of one of them, or delete it"
    return Finding(kind, rows[b], words, remedy, grave=kind == "same file")


def told(lots: frozenset[str]) -> str:
    """Name the lots that a photograph shows."""
    return f"of {', '.join(sorted(lots)) or 'no lot'}"
