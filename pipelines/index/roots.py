"""Where a row's photo lies: under a root that the user allowed, by its very name.

A manifest may come from anybody, so that it must not send this machine to hosts of its
choice. A name may begin or end with a blank, and so may a cell in which none was meant:
what is on disk tells which.
"""

import os
import posixpath
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from nostalgin_core.records import Rejection
from pipelines.index.manifest import Manifest
from pipelines.index.row import Refused, Row
from pipelines.store import SECRETIVE, Store, secretive

LOCAL: Final = "file"
SHOWN: Final = 80  # letters of a root in a message


def located(found: Manifest, city: str, schemes: Sequence[str]) -> Manifest:
    """Find each row's photo; a row whose root has another scheme is rejected.

    The scheme of the city folder itself is allowed, for the user named it.
    """
    results = [screened(row, city, schemes) for row in found.rows]
    rows = tuple(one for one in results if isinstance(one, Row))
    foreign = (one.why for one in results if isinstance(one, Refused))
    return replace(found, rows=rows, rejections=(*found.rejections, *foreign))


def screened(row: Row | Refused, city: str, schemes: Sequence[str]) -> Row | Refused:
    """Find one row's photo; what is refused already stays so."""
    if isinstance(row, Refused):
        return row
    if secretive(row.root):
        why = Rejection(row.key, "manifest", "credentials in its root", SECRETIVE)
        return Refused(why, photo=row.photo)
    if "://" in row.root:
        allowed = {LOCAL, scheme_of(city) or LOCAL, *(s.casefold() for s in schemes)}
        if scheme_of(row.root) not in allowed:
            return Refused(refused(row), row.root, row.photo)
    return spelt(row, city)


def scheme_of(root: str) -> str:
    """Tell the scheme of a URI in small letters; a path has none."""
    scheme, mark, _ = root.strip().partition("://")
    return scheme.casefold() if mark else ""


def refused(row: Row) -> Rejection:
    """Tell which scheme is not allowed, and how to allow it."""
    scheme = scheme_of(row.root)
    return Rejection(
        row.key,
        "manifest",
        "scheme not allowed",
        f"{row.root[:SHOWN]!r} is not on this machine: build with --allow-scheme "
        f"{scheme[:SHOWN]} if you trust it, or copy the photos and mend the root",
    )


def spelt(row: Row, city: str) -> Row:
    """Take a row's blanks for part of its names where such a file is there."""
    root, photo = row.root.strip(), row.photo.strip()
    if (root, photo) == (row.root, row.photo):
        return row
    trimmed = replace(row, root=root, photo=photo)
    if not row.photo:
        return trimmed
    for one in (
        row,
        replace(row, root=trimmed.root),
        replace(row, photo=trimmed.photo),
    ):
        if is_there(one, city):
            return one
    return trimmed


def is_there(row: Row, city: str) -> bool:
    """Tell whether a row's photo is a file; where nobody answers, it is none."""
    try:
        return Store(rooted(row.root, city)).exists(row.photo)
    except (OSError, ValueError):  # no answer, or no name
        return False


def rooted(root: str, city: str) -> str:
    """Resolve a photo folder that is written relative to the city folder."""
    if "://" in root or os.path.isabs(root):  # noqa: PTH117 - may be no local path
        return root
    if scheme_of(city):
        scheme, _, path = city.partition("://")
        path, mark, asked = path.partition("?")
        return f"{scheme}://{posixpath.normpath(f'{path}/{root}')}{mark}{asked}"
    return os.path.normpath(os.path.join(city, root))  # noqa: PTH118
