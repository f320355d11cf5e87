"""The painter's account of a photo: what each front and each occluder shows."""

import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.records import Box
from nostalgin_core.scenes import film, lens, surface, viewpoint
from nostalgin_core.scenes.composite import Plane, shrink, soften, spread
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.lot import Lot, Wall
from nostalgin_core.scenes.scenery import Clad, panel
from nostalgin_core.scenes.sprite import Sprite
from nostalgin_core.scenes.surface import Canvas
from nostalgin_core.scenes.truth import TrueFacade, TrueOccluder

LEAST_SHARE = 0.0012  # of the frame, for a front to count as shown


def true_facades(
    canvas: Canvas,
    through: Plane,
    camera: Camera,
    walls: list[Clad],
    *,
    lot: Lot,
    inside: Plane,
    hole: Plane | None,
    frame: Box,
) -> tuple[TrueFacade, ...]:
    """Write down every front that the frame shows enough of, from left to right."""
    shape = inside.shape
    counts = np.bincount(canvas.label.ravel() + 2, minlength=len(walls) + 2)[2:]
    own = {wall.front.front_id for wall in lot.walls if wall.front}
    film_share = inside if hole is None else inside * (1 - hole)
    open_view = soften(shrink(through), shape)
    open_view = open_view if hole is None else open_view * (1 - hole)
    found: list[TrueFacade] = []
    for label in np.flatnonzero(counts > LEAST_SHARE * canvas.label.size):
        wall, cloth = walls[label]
        assert wall.front is not None
        assert wall.style is not None
        mine = (canvas.label == label).astype(np.float32)
        alpha = soften(shrink(mine * through), shape) * film_share
        amodal = film.clip_to_frame(soften(shrink(mine), shape) > 0.5, inside)
        if amodal.sum() < LEAST_SHARE * amodal.size:
            continue
        found.append(
            measured(
                camera,
                wall,
                cloth(),
                masks=(amodal & (open_view > 0.5), amodal, alpha.astype(np.float32)),
                target=wall.front.front_id in own,
                frame=frame,
            )
        )
    return tuple(sorted(found, key=lambda facade: float(facade.quad[:, 0].mean())))


def measured(
    camera: Camera,
    wall: Wall,
    texture: Gray,
    *,
    masks: tuple[np.ndarray, np.ndarray, np.ndarray],
    target: bool,
    frame: Box,
) -> TrueFacade:
    """Measure one front: where it lands, what it vanishes to, what it looks like."""
    assert wall.front is not None
    ready = panel(wall, 0)
    quad = lens.project(camera, viewpoint.corners_m(wall))
    unit = lens.photo_from_plane(camera, ready.origin_m, ready.axes_m)
    across, up = ready.axes_m
    width = float(np.linalg.norm(across))
    directions = np.stack([across / width, up / wall.height_m])
    low, high = quad.min(axis=0), quad.max(axis=0)
    complete = (
        bool((low >= [frame.x0, frame.y0]).all())
        and bool((high < [frame.x1, frame.y1]).all())
        and float(lens.see(camera, viewpoint.corners_m(wall))[:, 2].min()) > 0
    )
    visible, amodal, alpha = masks
    return TrueFacade(
        front_id=wall.front.front_id,
        target=target,
        visible=visible,
        amodal=amodal,
        alpha=alpha,
        quad=quad,
        vanishing_points=lens.vanishing(camera, directions),
        aspect=width / wall.height_m,
        width_m=width,
        height_m=wall.height_m,
        texture=texture,
        m_per_px=width / texture.shape[1],
        photo_from_texture=unit @ surface.unit_from_texture(texture.shape),
        complete=complete,
    )


def true_occluders(
    sprites: list[Sprite],
    shares: list[Plane],
    shape: tuple[int, int],
    inside: Plane,
    hole: Plane | None,
) -> tuple[TrueOccluder, ...]:
    """Write down what hides the fronts, where a pixel's worth of it is seen."""
    found: list[TrueOccluder] = []
    film_share = inside
    if hole is not None:
        found.append(TrueOccluder("other", hole > 0.5, hole * inside))
        film_share = inside * (1 - hole)
    for sprite, share in zip(sprites, shares, strict=True):
        if sprite.category is None:
            continue
        alpha = spread(sprite, share, shape) * film_share
        mask = alpha > 0.5
        if mask.any():
            found.append(TrueOccluder(sprite.category, mask, alpha))
    return tuple(found)
