"""The images below a folder, and what there could not be read or named."""

import os
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import Final

from nostalgin_core.records import Rejection
from pipelines.store import textual

SUFFIXES: Final = (
    ".bmp .gif .j2k .jfif .jp2 .jpeg .jpg .png .tif .tiff .webp".split()  # noqa: SIM905
)
UNREAD: Final = (  # pictures, too: they are told, lest anybody misses them
    *(".avif", ".djvu", ".eps", ".heic", ".heif", ".jxl", ".pdf", ".psd"),
    *(".arw", ".cr2", ".cr3", ".dng", ".nef", ".orf"),  # raw
)
WRITTEN: Final = ("site", "artifacts", "runs", "readings")  # in the city folder


class Nothing(ValueError):  # noqa: N818 - it reads as what it is about
    """A folder or a catalogue that holds nothing to index, with the remedy."""


def images(folder: Path, city: str) -> tuple[list[str], list[Rejection]]:
    """List the images below a folder, by their paths relative to it.

    What lies in the city folder is none of them, if that is inside. Folders that can't
    be read, links to folders, images that are no files or whose names are no text, and
    pictures of formats that are not read are rejected by name.

    Raises:
        Nothing: if there is no such folder, or no image in it, or if it is one that
            `build` writes to.
    """
    try:
        there = folder.is_dir()
    except OSError as problem:
        raise Nothing(f"{folder}: {why(problem)}; name the photos' folder") from problem
    if not there:
        raise Nothing(f"{folder} is no folder: name the folder that holds the photos")
    if not textual(os.path.abspath(folder)):  # noqa: PTH100 - a link stays a link
        raise Nothing(f"{spelt_out(folder)}: a folder's name is not UTF-8; rename it")
    own, here = Path(city).resolve(), folder.resolve()
    outputs = [own / name for name in WRITTEN]
    if any(here.is_relative_to(output) for output in outputs):
        raise Nothing(f"{folder} is where build writes: move the photos elsewhere")
    if own != here and own.is_relative_to(here):
        outputs = [own]
    names, rejections = [], []
    for one in walked(here, set(map(str, outputs))):
        if isinstance(one, Rejection):
            rejections.append(one)
        else:
            names.append(one)
    rejections.sort(key=lambda one: one.key)
    if not names and rejections:
        first = rejections[0]
        raise Nothing(f"{folder}/{first.key}: {first.reason}; {first.detail}")
    if not names:
        raise Nothing(f"{folder} holds no image ({', '.join(SUFFIXES)})")
    return sorted(names), rejections


def walked(here: Path, outputs: Collection[str]) -> Iterator[str | Rejection]:
    """Walk all folders below one, however deep, but no links and no outputs."""
    waiting = [""]
    while waiting:
        at = waiting.pop()
        try:
            with os.scandir(here / at) as folder:
                entries = list(folder)
        except OSError as problem:
            yield refused(at or ".", "unreadable folder", why(problem))
            continue
        for entry in entries:
            name = f"{at}/{entry.name}" if at else entry.name
            if entry.is_dir(follow_symlinks=False):
                if entry.path not in outputs:
                    waiting.append(name)
            elif kind(entry.name) in UNREAD:
                how = "save it as JPEG, PNG or TIFF, beside it or in its place"
                yield refused(name, "a format that is not read", how)
            elif is_image(entry.name) or entry.is_symlink():
                yield from judged(name, entry)


def judged(name: str, entry: os.DirEntry[str]) -> Iterator[str | Rejection]:
    """Take an image, or tell why it is none."""
    try:
        file, folder = entry.is_file(), entry.is_dir()
    except OSError as problem:
        yield refused(name, "unreadable file", why(problem))
        return
    if folder:
        yield refused(name, "link to a folder", "links are not followed: index it too")
    elif not is_image(entry.name):
        return
    elif not file:
        detail = "a pipe, a device or a link to nothing: put the image in its place"
        yield refused(name, "no regular file", detail)
    elif not textual(name):
        yield refused(name, "file name is not UTF-8", "rename the file")
    else:
        yield name


def is_image(name: str) -> bool:
    """Tell whether a file is called as images are; blanks at the end are no matter."""
    return kind(name) in SUFFIXES


def kind(name: str) -> str:
    """Give a file's suffix in small letters; a name that is hidden has none."""
    _, dot, suffix = name.rpartition(".")
    hidden = name.startswith(".") and name.count(".") == 1
    return "" if hidden else f"{dot}{suffix.strip().casefold()}"


def why(problem: OSError) -> str:
    """Tell what is wrong with a file or a folder, and what to do."""
    return f"{problem.strerror}; let it be read, or move it away"


def refused(name: str, reason: str, detail: str) -> Rejection:
    """Reject what can't be indexed, whatever bytes its name has."""
    return Rejection(spelt_out(name), "catalogue", reason, detail)


def spelt_out(name: str | Path) -> str:
    """Spell out the bytes of a name that are no text."""
    return os.fsencode(name).decode(errors="backslashreplace")
