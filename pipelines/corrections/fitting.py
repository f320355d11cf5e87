"""Do shapes that people drew lie in their photographs? Their headers tell."""

from collections.abc import Iterator
from dataclasses import replace

from nostalgin_core import photo
from nostalgin_core.records import Rejection
from pipelines import bounded
from pipelines.corrections import shapes
from pipelines.corrections.applied import Applied
from pipelines.index.roots import rooted
from pipelines.store import Store


def fitting(made: Applied, store: Store) -> Applied:
    """Reject the shapes that leave their photographs, by their rows.

    A photograph that can't be read is rejected elsewhere.
    """
    if not made.outlines and not made.quads:
        return made
    drawn = {"mask": dict(made.outlines), "quad": dict(made.quads)}
    sizes = dict(sizes_of(made, store))
    kept, rejections = [], list(made.rejections)
    for change in made.changes:
        size, own = sizes.get(change.subject), drawn.get(change.what)
        words = ""
        if size is not None and own is not None:
            points = shapes.read(own[change.subject])
            words = shapes.misfit(change.what, points, size)
        if words and own is not None:
            del own[change.subject]
            detail = f"{change.what} of {change.subject[:80]}: {words}"
            why = Rejection(change.row, "corrections", "outside its photo", detail)
            rejections.append(why)
        else:
            kept.append(change)
    return replace(
        made,
        changes=tuple(kept),
        rejections=tuple(rejections),
        outlines=drawn["mask"],
        quads=drawn["quad"],
    )


def sizes_of(made: Applied, store: Store) -> Iterator[tuple[str, tuple[int, int]]]:
    """Read the sizes of the photographs that somebody drew on."""
    wanted = made.outlines.keys() | made.quads.keys()
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
