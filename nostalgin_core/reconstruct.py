"""All stages as a plain loop: the oracle that the pipeline must agree with.

No Beam, no store, no worker: one photo after the other, then one block, in memory. What
the pipeline writes equals what this loop returns, byte for byte.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from nostalgin_core import block, model, quantise, steps
from nostalgin_core.block import Settled
from nostalgin_core.records import Front, Photo, Rejection, Seen
from nostalgin_core.steps import Networks, Stages


@dataclass(frozen=True, slots=True, eq=False)
class Rebuilt:
    """A block as it was rebuilt from photos."""

    settled: Settled
    glb: bytes
    rejections: tuple[Rejection, ...]


def rebuild(
    name: str,
    fronts: Sequence[Front],
    photos: Mapping[str, tuple[bytes, Sequence[str]]],
    networks: Networks,
    *,
    credit: str = "",
) -> Rebuilt:
    """Rebuild one block from photos, each with the ids of the fronts it may show.

    Every facade is inpainted here, those that no wall wears too; a pipeline may leave
    these out.
    """
    made = {
        file: steps.photograph(data, networks, name=file)
        for file, (data, _) in sorted(photos.items())
    }
    seen = [each for one in made.values() for each in sums(one)]
    candidates = {
        one.photo.key: photos[file][1]
        for file, one in made.items()
        if one.photo is not None and one.rectified
    }
    settled = block.settle(name, fronts, candidates, seen)
    finished = {
        (one.photo.key, view.facade): quantise.elevation(view)
        for one in made.values()
        if isinstance(one.photo, Photo)
        for view in one.elevations
    }
    rights = model.Rights(credit)
    glb = model.model(settled, finished, rights=rights).glb
    photo_rejections = [each for one in made.values() for each in one.rejections]
    return Rebuilt(settled, glb, (*photo_rejections, *settled.rejections))


def sums(one: Stages) -> list[Seen]:
    """Sum up every facade of a photo that has an elevation."""
    if one.photo is None or one.matted is None:
        return []
    facades = {facade.index: facade for facade in one.matted.facades}
    return [
        steps.seen(one.photo.key, facades[view.facade], view) for view in one.rectified
    ]
