"""Does what people point at lie in their photographs? Their headers tell."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

from nostalgin_core import photo
from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.corrections import shapes
from pipelines.corrections.applied import Applied, Change
from pipelines.index.roots import rooted
from pipelines.store import Store

Sizes = Mapping[str, tuple[int, int]]  # width and height in pixels, by photo


def fitting(made: Applied, store: Store) -> Applied:
    """Reject the shapes and targets that leave their photographs, by their rows.

    A photograph that can't be read is rejected elsewhere.
    """
    if not pointed_at(made):
        return made
    sizes = dict(sizes_of(made, store))
    outside = {change: misfit(made, change, sizes) for change in made.changes}
    rejections = [
        Rejection(
            change.row,
            "corrections",
            "outside its photo",
            f"{change.what} of {change.subject[:80]}: {words}",
        )
        for change, words in outside.items()
        if words
    ]
    gone = {(one.what, one.subject) for one, words in outside.items() if words}
    return replace(
        made,
        changes=tuple(one for one, words in outside.items() if not words),
        rejections=(*made.rejections, *rejections),
        outlines={n: v for n, v in made.outlines.items() if ("mask", n) not in gone},
        quads={n: v for n, v in made.quads.items() if ("quad", n) not in gone},
        targets_px={
            n: v for n, v in made.targets_px.items() if ("target", n) not in gone
        },
    )


def pointed_at(made: Applied) -> set[str]:
    """Name the photographs that somebody drew on, or whose facade somebody chose."""
    return {*made.outlines, *made.quads, *made.targets_px}


def misfit(made: Applied, change: Change, sizes: Sizes) -> str:
    """Tell how a change leaves its photograph, if it does and that can be read."""
    size_px = sizes.get(change.subject)
    if size_px is None:
        return ""
    if change.what == "target":
        x, width = made.targets_px[change.subject], size_px[0]
        words = f"x = {x:g} lies beyond its photo, which is {width} pixels wide"
        return "" if x < width else f"{words}: mend the value"
    drawn = {"mask": made.outlines, "quad": made.quads}.get(change.what)
    if drawn is None:
        return ""
    return shapes.misfit(change.what, shapes.read(drawn[change.subject]), size_px)


def sizes_of(made: Applied, store: Store) -> Iterator[tuple[str, tuple[int, int]]]:
    """Read the sizes of the photographs that are pointed at."""
    wanted = pointed_at(made)
    for row in made.rows:
        if row.photo not in wanted:
            continue
        wanted = wanted - {row.photo}
        try:
            where = Store(rooted(row.root, store.root))
            size = photo.size_px(where.read_bytes(row.photo, bounded.PHOTO_BYTES))
        except (OSError, ValueError):
            continue
        if size is not None:
            yield row.photo, size
