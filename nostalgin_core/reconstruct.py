"""All stages as a plain loop: the oracle that the pipeline must agree with.

No Beam, no store, no worker: one photo after the other, then one block, in memory. What
the pipeline writes equals what this loop returns, byte for byte.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from nostalgin_core import (
    block,
    borrow,
    inpaint,
    model,
    quantise,
    rectify,
    steps,
    views,
)
from nostalgin_core.block import Settled
from nostalgin_core.borrow import Lender
from nostalgin_core.records import Drawn, Elevation, Front, Rejection, Seen, Texture
from nostalgin_core.steps import Networks, Stages
from nostalgin_core.views import Alike, Stretch

UNDRAWN: Final[Mapping[str, Drawn]] = MappingProxyType({})


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
    drawn: Mapping[str, Drawn] = UNDRAWN,
    mark: rectify.Watermark | None = None,
) -> Rebuilt:
    """Rebuild one block from photos, each with the ids of the fronts it may show.

    Every facade is inpainted here, those that no wall wears too; a pipeline may leave
    these out. `drawn` is what somebody drew on photos, by their names, `mark` what is
    taken out of what walls wear.
    """
    made = {
        file: steps.photograph(
            data, networks, name=file, drawn=drawn.get(file, steps.UNDRAWN), mark=mark
        )
        for file, (data, _) in sorted(photos.items())
    }
    seen = [each for one in made.values() for each in sums(one)]
    candidates = {
        one.photo.key: photos[file][1]
        for file, one in made.items()
        if one.photo is not None and one.rectified
    }
    stretches = [each for one in made.values() for each in stretched(one)]
    alike = compared(fronts, candidates, stretches, made.values())
    settled = block.settle(
        name, fronts, candidates, seen, stretches=stretches, alike=alike
    )
    finished = textures((one, one.elevations) for one in made.values())
    rectified = textures((one, one.rectified) for one in made.values())
    for one in settled.shown():
        if one.lenders:
            lenders = [
                Lender(texture[0], rectified[texture]) for texture in one.lenders
            ]
            view = borrow.borrow(rectified[one.texture], lenders).elevation
            view = inpaint.inpaint(view, networks.inpaint)
            finished[one.texture] = quantise.elevation(view)
    worn = {key for one in settled.shown() for key, _ in (one.texture, *one.lenders)}
    marks = {
        one.watermark for one in made.values() if one.photo and one.photo.key in worn
    }
    rights = model.Rights(credit, watermarks=tuple(sorted(marks - {""})))
    glb = model.model(settled, finished, rights=rights).glb
    photo_rejections = [each for one in made.values() for each in one.rejections]
    return Rebuilt(settled, glb, (*photo_rejections, *settled.rejections))


def textures(
    made: Iterable[tuple[Stages, Sequence[Elevation]]],
) -> dict[Texture, Elevation]:
    """Name elevations by photo and facade, rounded as between stages."""
    return {
        (one.photo.key, view.facade): quantise.elevation(view)
        for one, views_of in made
        if one.photo is not None
        for view in views_of
    }


def sums(one: Stages) -> list[Seen]:
    """Sum up every facade of a photo that has an elevation."""
    if one.photo is None or one.matted is None:
        return []
    facades = {facade.index: facade for facade in one.matted.facades}
    return [
        steps.seen(one.photo.key, facades[view.facade], view) for view in one.rectified
    ]


def stretched(one: Stages) -> list[Stretch]:
    """Sum up where the facades of a photo stand on their street."""
    if one.photo is None:
        return []
    frame, (h, w) = one.photo.frame, one.photo.image.shape
    return [
        views.stretch(numbers, rectify.standpoint(view, frame=frame, shape=(h, w)))
        for numbers, view in zip(sums(one), one.rectified, strict=True)
    ]


def compared(
    fronts: Sequence[Front],
    candidates: Mapping[str, Sequence[str]],
    stretches: Sequence[Stretch],
    made: Iterable[Stages],
) -> Alike:
    """Compare the facades that may show one front."""
    elevations = {
        (one.photo.key, view.facade): views.seen_on(view)
        for one in made
        if one.photo is not None
        for view in one.rectified
    }
    return views.compared(fronts, candidates, stretches, elevations.__getitem__)
