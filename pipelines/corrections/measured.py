"""What a shape that somebody drew changed, measured where it is built.

The size of a front's mask, how far the corners of its quad moved, and its height over
its width, before and after.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Final

import numpy as np

from pipelines.corrections import shapes
from pipelines.corrections.applied import Applied
from pipelines.corrections.found import Found, content, found, published
from pipelines.corrections.shapes import Points
from pipelines.index.roots import rooted
from pipelines.store import Store

NOT_YET: Final = "not built yet"
NOTHING: Final = "no front was found"


def measured(made: Applied, store: Store) -> Applied:
    """Tell of each mask and quad what it changed, as far as that is built."""
    if not made.outlines and not made.quads:
        return made
    versions = published(store)
    roots = {row.photo: row.root for row in reversed(made.rows)}
    told = []
    for one in made.changes:
        if one.what not in ("mask", "quad"):
            told.append(one)
            continue
        sha256 = content(rooted(roots[one.subject], store.root), one.subject)
        look = partial(found, store, versions, sha256) if versions and sha256 else None
        outline = made.outlines.get(one.subject, "")
        quad = made.quads.get(one.subject, "")
        points = shapes.read(one.after)
        if one.what == "mask":
            before, after = (look(), look(outline)) if look else ((), ())
            words = masks(points, before, after)
        else:
            before, after = (look(outline), look(outline, quad)) if look else ((), ())
            if look and all(front.quad is None for front in before):
                before = look()  # no run had the outline and not the quad
            words = quads(points, before, after)
        told.append(replace(one, before=words[0], after=words[1]))
    return replace(made, changes=tuple(told))


def masks(
    points: Points, before: Sequence[Found], after: Sequence[Found]
) -> tuple[str, str]:
    """Tell the sizes of the mask that a drawn one replaces, and of that."""
    old, new = nearest(points, before), nearest(points, after)
    was = NOTHING if old is None else f"{old.area_px} px"
    if new is None:
        return (was if old else NOT_YET), f"{len(points)} points, {NOT_YET}"
    return was, f"{new.area_px} px"


def quads(
    points: Points, before: Sequence[Found], after: Sequence[Found]
) -> tuple[str, str]:
    """Tell the proportions before and after, and how far each corner moved."""
    old, new = nearest(points, before), nearest(points, after)
    if old is None:
        return NOT_YET, f"drawn, {NOT_YET}"
    if old.quad is None:
        return "not straightened", proportions(new)
    moved = ", ".join(f"{one:.0f}" for one in np.hypot(*(points - old.quad).T))
    return proportions(old), f"{proportions(new)}, corners moved {moved} px"


def nearest(points: Points, some: Sequence[Found]) -> Found | None:
    """Find the front that shares most with a shape."""
    return max(some, key=lambda one: one.like(points), default=None)


def proportions(one: Found | None) -> str:
    """Tell a front's height over its width."""
    if one is None or one.aspect is None:
        return NOT_YET
    return f"height / width {1 / one.aspect:.3f}"
