"""Take a painted lot's photo, and write down the truth of every pixel.

Walls and ground are drawn at twice the photo's size with exact depth; people, cars and
signs are soft sprites before them. Light from a sprite k reaches the film as

    w_k = a_k prod_{j nearer} (1 - a_j),      facade i: [label = i] prod_j (1 - a_j),

and all these shares sum to one in every pixel. Shrinking and the lens's softness are
linear, so they are applied to picture and shares alike, and the sum stays one.
"""

import functools
from collections.abc import Callable

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Gray
from nostalgin_core.records import Box
from nostalgin_core.scenes import (
    crowd,
    film,
    front,
    ground,
    lens,
    relief,
    surface,
    viewpoint,
)
from nostalgin_core.scenes import (
    wall as masonry,
)
from nostalgin_core.scenes.catalogue import photo_name
from nostalgin_core.scenes.front import FrontStyle
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.sprite import Sprite
from nostalgin_core.scenes.street import Lot, Neighbourhood, PaintedBlock, Wall
from nostalgin_core.scenes.surface import Canvas, Panel
from nostalgin_core.scenes.truth import PaintedPhoto, TrueFacade, TrueOccluder, Truth

SUPER = 2  # samples a pixel and axis
PX_PER_M = 40.0  # of a texture: what a tax photo resolves
FINE_M = 55.0  # beyond it, fronts wear coarser textures
SOFT_PX = 0.62  # the lens's point spread at 560 pixels' width
LEAST_SHARE = 0.0012  # of the frame, for a front to count as shown
BLANK = -2  # the label of party walls
Plane = Float[np.ndarray, "_ _"]  # shapes differ: photo, supersampled, sprite

Wear = Callable[[FrontStyle], Gray | None]
Clad = tuple[Wall, Callable[[], Gray]]

texture_of = functools.lru_cache(maxsize=256)(front.paint)


def photograph(
    neighbourhood: Neighbourhood,
    lot: Lot,
    rng: np.random.Generator,
    *,
    shape: tuple[int, int] = (840, 560),
    view: int = 0,
    camera: Camera | None = None,
    wear: Wear | None = None,
) -> PaintedPhoto:
    """Take one photo of a lot.

    The camera is chosen where none is given. `wear` may give a front another texture
    than its own, of about the same aspect.
    """
    blocks = [*neighbourhood.blocks, *neighbourhood.around]
    boxes = [block.corner_m for block in blocks]
    camera = camera or viewpoint.choose(rng, lot, boxes, shape=shape)
    frame, inside = film.exposed(rng, shape)
    text = f"{lot.block}-{lot.lot} M"
    if lot.ruined:
        fogged = film.develop(rng, film.fog(rng, shape), inside)
        nothing = np.ones(shape, np.float32)
        truth = Truth(camera, (), (), nothing, text, frame)
        return PaintedPhoto(photo_name(lot, view), fogged, truth)
    fine = magnified(camera)
    size = (SUPER * shape[0], SUPER * shape[1])
    canvas, walls = build(rng, fine, blocks, size, wear=wear)
    sprites = dress(rng, fine, canvas.tone.shape, lot, blocks, text=text)
    light, shares, through = composite(canvas, sprites)
    hole = film.punch(rng, shape) if rng.random() < 0.12 else None
    facades = true_facades(canvas, through, camera, walls, lot, inside, hole, frame)
    occluders = true_occluders(sprites, shares, shape, inside, hole)
    image = soften(shrink(light), shape)
    if hole is not None:
        image = image * (1 - hole) + 6.0 * hole
    used = sum((thing.alpha for thing in (*facades, *occluders)), np.zeros(shape))
    rest = np.clip(1.0 - used, 0.0, 1.0).astype(np.float32)
    truth = Truth(camera, facades, occluders, rest, text, frame)
    negative = film.develop(rng, image, inside)
    return PaintedPhoto(photo_name(lot, view), negative, truth)


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


def build(
    rng: np.random.Generator,
    camera: Camera,
    blocks: list[PaintedBlock],
    shape: tuple[int, int],
    *,
    wear: Wear | None,
) -> tuple[Canvas, list[Clad]]:
    """Draw all walls, the ground and the sky.

    Returns the fronts that show, with what they wear, in the order of their labels.
    """
    canvas = surface.empty(shape)
    standing = [
        (distance(camera, wall), wall)
        for block in blocks
        for lot in block.lots
        for wall in lot.walls
        if faces(camera, wall, shape)
    ]
    walls: list[Clad] = []
    for away, wall in sorted(standing, key=lambda item: item[0]):
        label = len(walls) if wall.style else BLANK
        cloth = dressing(wall, away, wear)
        if surface.draw(canvas, camera, panel(wall, label), cloth):
            walls.extend([(wall, cloth)] if wall.style else [])
    ground.lay(rng, canvas, camera, [block.corner_m for block in blocks])
    haze(rng, canvas)
    ground.sky(rng, canvas)
    return canvas, walls


def distance(camera: Camera, wall: Wall) -> float:
    """Measure how far the nearer end of a wall is."""
    ends = np.array([wall.start_m, wall.end_m])
    return float(np.linalg.norm(ends - camera.eye_m[:2], axis=1).min())


def dressing(wall: Wall, away_m: float, wear: Wear | None) -> Callable[[], Gray]:
    """Say what a wall wears: its painted front, coarser far away, or common brick."""
    if wall.style is None:
        kind = int(abs(wall.start_m[0] * 7 + wall.start_m[1] * 13)) % 7
        return functools.partial(party_wall, kind)
    worn = wear(wall.style) if wear else None
    if worn is not None:
        return lambda: worn
    scale = PX_PER_M if away_m < FINE_M else PX_PER_M / 2
    return functools.partial(texture_of, wall.style, px_per_m=scale)


def faces(camera: Camera, wall: Wall, shape: tuple[int, int]) -> bool:
    """Say whether a wall turns its outside to the camera and is in view."""
    start, end = np.array(wall.start_m), np.array(wall.end_m)
    along = end - start
    out = np.array([along[1], -along[0]])
    if out @ (camera.eye_m[:2] - start) <= 0:
        return False
    return surface.bounds(camera, viewpoint.corners_m(wall), shape) is not None


def panel(wall: Wall, label: int) -> Panel:
    """Make a wall ready to draw."""
    start, end = np.array([*wall.start_m, 0.0]), np.array([*wall.end_m, 0.0])
    axes = np.stack([end - start, [0.0, 0.0, wall.height_m]])
    return Panel(start, axes, label)


@functools.lru_cache(maxsize=64)
def party_wall(seed: int) -> Gray:
    """Paint one tall piece of common brick."""
    rng = np.random.default_rng(seed)
    board = relief.blank(20.0, 22.0, px_per_m=16.0)
    masonry.clad(rng, board, material="stucco", albedo=float(rng.uniform(0.16, 0.34)))
    worn = masonry.weather(rng, board.albedo, px_per_m=16.0)
    return np.round(255 * worn**0.62).astype(np.uint8)


def haze(rng: np.random.Generator, canvas: Canvas) -> None:
    """Let the city's air lighten what is far away."""
    reach = rng.uniform(250.0, 600.0)
    near = np.maximum(canvas.nearness, np.float32(1e-4))
    clear = np.exp(-1.0 / (near * np.float32(reach)))
    far = canvas.nearness > 0
    veiled = clear * canvas.tone + (1 - clear) * 205.0
    canvas.tone[far] = veiled[far]


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


def composite(
    canvas: Canvas, sprites: list[Sprite]
) -> tuple[Plane, list[Plane], Plane]:
    """Lay sprites over the walls, near ones first.

    Returns the light, each sprite's share of it (the size of the sprite), and what is
    left for the walls.
    """
    through = np.ones_like(canvas.tone)
    light = np.zeros_like(canvas.tone)
    shares: list[Plane] = []
    for sprite in sprites:
        x, y = sprite.corner_px
        h, w = sprite.alpha.shape
        window = np.s_[y : y + h, x : x + w]
        wall = canvas.label[window] != surface.NOBODY
        hidden = wall & (canvas.nearness[window] > 1 / sprite.depth_m)
        alpha = np.where(hidden, np.float32(0), sprite.alpha)
        share = alpha * through[window]
        light[window] += share * sprite.tone
        through[window] *= 1 - alpha
        shares.append(share)
    return light + through * canvas.tone, shares, through


def shrink(plane: Plane) -> Plane:
    """Average the samples of each pixel."""
    h, w = plane.shape
    size = (w // SUPER, h // SUPER)
    return cv2.resize(plane, size, interpolation=cv2.INTER_AREA)


def soften(plane: Plane, shape: tuple[int, int]) -> Plane:
    """Apply the lens's point spread."""
    return cv2.GaussianBlur(plane, (0, 0), SOFT_PX * shape[1] / 560)


def true_facades(
    canvas: Canvas,
    through: Plane,
    camera: Camera,
    walls: list[Clad],
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
        alpha = spread(sprite, share, shape) * film_share
        mask = alpha > 0.5
        if mask.any():
            found.append(TrueOccluder(sprite.category, mask, alpha))
    return tuple(found)


def spread(sprite: Sprite, share: Plane, shape: tuple[int, int]) -> Plane:
    """Shrink and soften one sprite's share, working only where it is."""
    pad = 8
    x, y = sprite.corner_px
    h, w = share.shape
    x0, y0 = max(0, x // SUPER - pad), max(0, y // SUPER - pad)
    x1 = min(shape[1], (x + w) // SUPER + 1 + pad)
    y1 = min(shape[0], (y + h) // SUPER + 1 + pad)
    fine = np.zeros((SUPER * (y1 - y0), SUPER * (x1 - x0)), np.float32)
    top, left = y - SUPER * y0, x - SUPER * x0
    fine[top : top + h, left : left + w] = share
    whole = np.zeros(shape, np.float32)
    whole[y0:y1, x0:x1] = soften(shrink(fine), shape)
    return whole
