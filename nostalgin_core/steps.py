"""One photo through its stages, from its bytes to its elevations."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from nostalgin_core import (
    evidence,
    inpaint,
    matte,
    photo,
    placard,
    quantise,
    rectify,
    segment,
    storeys,
)
from nostalgin_core.records import (
    Drawn,
    Elevation,
    Facade,
    Instance,
    Matted,
    Photo,
    Placard,
    Rejection,
    Seen,
)

UNDRAWN: Final = Drawn(None, None)
DRAWN_TO_PX: Final = 1.0  # how surely a hand places a corner, in a photo shown whole


@dataclass(frozen=True, slots=True)
class Networks:
    """The callables that the stages are given. Without `read`, no placard is read."""

    segment: Callable[..., Any]
    inpaint: Callable[..., Any]
    read: Callable[..., Any] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Stages:
    """Everything the stages made of one photo, as far as they came."""

    photo: Photo | None = None
    instances: tuple[Instance, ...] = ()
    placard: Placard | None = None
    matted: Matted | None = None
    rectified: tuple[Elevation, ...] = ()
    watermark: str = ""  # words of one that was taken out of them
    elevations: tuple[Elevation, ...] = ()
    rejections: tuple[Rejection, ...] = field(default=())


def steps(
    data: bytes,
    networks: Networks,
    *,
    name: str,
    every: bool = True,
    drawn: Drawn = UNDRAWN,
    mark: rectify.Watermark | None = None,
) -> Iterator[tuple[str, Any]]:
    """Yield each stage's word and its result, and end with a photo's rejection.

    Unless `every` facade is wanted, only the targets are inpainted, which is the
    costliest stage; all of them where no target has an elevation. What is `drawn` takes
    the place of what was found. A `mark` is taken out of the elevations, not the photo.

    A caller that wants to know what a stage costs looks at its own clock between two
    results. A placard that can't be read stops nothing.
    """
    picture = photo.decode(data, name=name)
    yield "photo", picture
    if isinstance(picture, Rejection):
        return
    instances = segment.segment(picture, networks.segment)
    if isinstance(instances, Rejection):
        yield "segment", instances
        if drawn.outline is None:
            return
        instances = ()
    instances = quantise.instances(instances)
    yield "segment", instances
    if networks.read is not None:
        yield "placard", placard.read(picture, placard.board(instances), networks.read)
    matted = front(picture, instances, drawn)
    if isinstance(matted, Rejection):
        yield "matte", matted
        return
    matted = quantise.matted(matted)
    yield "matte", matted
    clear, words = rectify.unmarked(picture, mark)
    rectified = straightened(clear, matted, drawn)
    yield "rectify", rectified
    if words:
        yield "watermark", words
    views = [one for one in rectified if isinstance(one, Elevation)]
    targets = {one.index for one in matted.facades if one.target}
    chosen = [one for one in views if not every and one.facade in targets] or views
    yield "inpaint", tuple(inpaint.inpaint(one, networks.inpaint) for one in chosen)


def front(
    picture: Photo, instances: Sequence[Instance], drawn: Drawn
) -> Matted | Rejection:
    """Matte a photo, by the outline that is drawn of its front if one is."""
    if drawn.outline is None:
        return matte.matte(picture, instances)
    return matte.redrawn(picture, instances, drawn.outline)


def straightened(
    picture: Photo, matted: Matted, drawn: Drawn
) -> tuple[Elevation | Rejection, ...]:
    """Straighten a photo's fronts, one by the quad that is drawn if one is."""
    views = rectify.rectify(picture, matted)
    if drawn.quad is not None:
        views = rectify.drawn(picture, matted, views, drawn.quad, sd_px=DRAWN_TO_PX)
    return tuple(map(rounded, views))


def rounded(one: Elevation | Rejection) -> Elevation | Rejection:
    """Round an elevation's alpha, and pass a rejection on."""
    return one if isinstance(one, Rejection) else quantise.elevation(one)


def gather(results: Iterator[tuple[str, Any]]) -> Stages:
    """Collect the results of `steps` into one record."""
    made: dict[str, Any] = {}
    rejections: list[Rejection] = []
    for stage, result in results:
        if isinstance(result, Rejection):
            rejections.append(result)
        elif stage == "rectify":
            rejections += [one for one in result if isinstance(one, Rejection)]
            made["rectified"] = tuple(o for o in result if isinstance(o, Elevation))
        else:
            made[FIELD.get(stage, stage)] = result
    return Stages(**made, rejections=tuple(rejections))


FIELD = {"segment": "instances", "matte": "matted", "inpaint": "elevations"}


def photograph(
    data: bytes,
    networks: Networks,
    *,
    name: str,
    drawn: Drawn = UNDRAWN,
    mark: rectify.Watermark | None = None,
) -> Stages:
    """Take one photo through every stage, from its bytes to its elevations."""
    return gather(steps(data, networks, name=name, drawn=drawn, mark=mark))


def seen(key: str, facade: Facade, view: Elevation) -> Seen:
    """Sum up a facade in the numbers that `assign` weighs."""
    somewhere = np.count_nonzero(view.evidence != evidence.NOTHING)
    by_camera = (evidence.PHOTOGRAPHED, evidence.SOFT_EDGE)
    photographed = np.count_nonzero(np.isin(view.evidence, by_camera))
    return Seen(
        photo=key,
        facade=facade.index,
        target=facade.target,
        target_score=facade.target_score,
        score=facade.score,
        aspect=view.aspect,
        aspect_sd=view.aspect_sd,
        left_px=float(view.quad[:, 0].mean()),
        area_px=float(facade.alpha.sum(dtype=np.float64)),
        photographed=photographed / max(somewhere, 1),
        stretched=rectify.stretched(view),
        sharpness=rectify.sharpness(view, float(facade.alpha.sum(dtype=np.float64))),
        storeys=tuple(storeys.scores(view.image, np.isin(view.evidence, by_camera))),
    )
