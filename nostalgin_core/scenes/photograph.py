"""Take a painted lot's photo, and write down the truth of every pixel.

Walls and ground are drawn at twice the photo's size with exact depth; people, cars and
signs are soft sprites before them.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from nostalgin_core.scenes import crowd, film, flaws, lens, skyline, viewpoint
from nostalgin_core.scenes.account import true_facades, true_occluders
from nostalgin_core.scenes.catalogue import photo_name
from nostalgin_core.scenes.composite import SUPER, composite, shrink, soften
from nostalgin_core.scenes.flaws import Flaws
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.lot import Lot
from nostalgin_core.scenes.scenery import Wear, build
from nostalgin_core.scenes.sprite import Sprite
from nostalgin_core.scenes.street import Neighbourhood, PaintedBlock
from nostalgin_core.scenes.truth import PaintedPhoto, TrueFacade, Truth

PERFECT = Flaws()


def album(
    neighbourhood: Neighbourhood, *, seed: int, shape: tuple[int, int] = (840, 560)
) -> Iterator[PaintedPhoto]:
    """Take every photo that the catalogue lists, in its order, one at a time."""
    for block in neighbourhood.blocks:
        for lot in block.lots:
            for view in range(lot.photos):
                rng = np.random.default_rng([seed, int(lot.block), int(lot.lot), view])
                yield photograph(neighbourhood, lot, rng, shape=shape, view=view)


def photograph(
    neighbourhood: Neighbourhood,
    lot: Lot,
    rng: np.random.Generator,
    *,
    shape: tuple[int, int] = (840, 560),
    view: int = 0,
    camera: Camera | None = None,
    wear: Wear | None = None,
    flawed: Flaws = PERFECT,
) -> PaintedPhoto:
    """Take one photo of a lot.

    The camera is chosen where none is given. `wear` may give a front another texture
    than its own, of about the same aspect. Fronts are even and the lens is perfect
    unless `flawed` says how much they are not; a bent photo's quads are bent, too.
    """
    blocks = [*neighbourhood.blocks, *neighbourhood.around]
    boxes = [block.corner_m for block in blocks]
    camera = camera or viewpoint.choose(rng, lot, boxes, shape=shape)
    frame, inside = film.exposed(rng, shape)
    text = f"{lot.block} -{lot.lot} M"
    if lot.ruined:  # the fog has eaten everything
        fogged = film.develop(rng, film.fog(rng, shape), inside)
        truth = Truth(camera, (), (), np.ones(shape, np.float32), text, frame)
        return PaintedPhoto(photo_name(lot, view), fogged, truth)
    fine = magnified(camera)
    size = (SUPER * shape[0], SUPER * shape[1])
    sun, stray_m = neighbourhood.sun, flawed.stray_m
    built = build(rng, fine, blocks, size, sun=sun, wear=wear, stray_m=stray_m)
    canvas, walls = built
    canvas = flaws.bend(canvas, flawed.barrel) if flawed.barrel else canvas
    sprites = dress(rng, fine, canvas.tone.shape, lot, blocks, text=text)
    light, shares, through = composite(canvas, sprites)
    hole = film.punch(rng, shape) if rng.random() < 0.12 else None
    shown = {"lot": lot, "inside": inside, "hole": hole, "frame": frame}
    facades = true_facades(canvas, through, camera, walls, **shown)
    facades = as_bent(facades, shape, flawed.barrel)
    occluders = true_occluders(sprites, shares, shape, inside, hole)
    image = soften(shrink(light), shape)
    if hole is not None:
        image = image * (1 - hole) + 6.0 * hole
    used = sum((thing.alpha for thing in (*facades, *occluders)), np.zeros(shape))
    rest = np.clip(1.0 - used, 0.0, 1.0).astype(np.float32)
    truth = Truth(camera, facades, occluders, rest, text, frame)
    negative = film.develop(rng, image, inside)
    return PaintedPhoto(photo_name(lot, view), negative, truth)


def as_bent(
    facades: tuple[TrueFacade, ...], shape: tuple[int, int], barrel: float
) -> tuple[TrueFacade, ...]:
    """Bend the quads of facades as the lens bends the picture."""
    if not barrel:
        return facades
    return tuple(
        replace(one, quad=flaws.bent(one.quad, shape, barrel)) for one in facades
    )


def magnified(camera: Camera) -> Camera:
    """Give the camera of the supersampled picture: pixel centres stay whole."""
    cx, cy = camera.principal_px
    middle = (SUPER - 1) / 2
    return Camera(
        SUPER * camera.focal_px,
        (SUPER * cx + middle, SUPER * cy + middle),
        camera.rotation,
        camera.translation_m,
    )


def dress(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    lot: Lot,
    blocks: list[PaintedBlock],
    *,
    text: str,
) -> list[Sprite]:
    """Put everything that stands before the fronts into the scene, near ones first."""
    lots = [each for block in blocks for each in block.lots]
    middles = [
        viewpoint.corners_m(wall).mean(axis=0) for wall in lot.walls if wall.front
    ]
    towards = lens.project(camera, np.array(middles)).mean(axis=0)[0]
    sprites = [
        *crowd.populate(rng, camera, shape, blocks),
        *crowd.fittings(rng, camera, shape, lots),
        *skyline.rise(rng, camera, shape, blocks),
        *crowd.surveyors(rng, camera, shape, text=text, towards_px=float(towards)),
    ]
    return sorted(unmask(sprites), key=lambda sprite: sprite.depth_m)


def unmask(sprites: list[Sprite]) -> list[Sprite]:
    """Wait until nothing stands before the number board, as the photographer did."""
    board = next((each for each in sprites if each.category == "placard"), None)
    if board is None:
        return sprites
    return [
        each
        for each in sprites
        if each.depth_m >= board.depth_m or not overlapping(each, board)
    ]


def overlapping(one: Sprite, other: Sprite) -> bool:
    """Say whether two sprites' boxes share a pixel."""
    (x0, y0), (h0, w0) = one.corner_px, one.alpha.shape
    (x1, y1), (h1, w1) = other.corner_px, other.alpha.shape
    return x0 < x1 + w1 and x1 < x0 + w0 and y0 < y1 + h1 and y1 < y0 + h0
