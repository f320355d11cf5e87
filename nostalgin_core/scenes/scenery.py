"""All walls of the neighbourhood in their clothes, with the ground and the sky."""

import functools
from collections.abc import Callable

import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.scenes import flaws, front, ground, relief, surface, viewpoint
from nostalgin_core.scenes import wall as masonry
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.lot import Wall
from nostalgin_core.scenes.street import PaintedBlock
from nostalgin_core.scenes.style import FrontStyle
from nostalgin_core.scenes.surface import Canvas, Panel

PX_PER_M = 40.0  # of a texture: what a tax photo resolves
FINE_M = 55.0  # beyond it, fronts wear coarser textures
BLANK = -2  # the label of party walls
Wear = Callable[[FrontStyle], Gray | None]
Clad = tuple[Wall, Callable[[], Gray]]

texture_of = functools.lru_cache(maxsize=256)(front.paint)


def build(
    rng: np.random.Generator,
    camera: Camera,
    blocks: list[PaintedBlock],
    shape: tuple[int, int],
    *,
    sun: tuple[float, float, float],
    wear: Wear | None,
    stray_m: float = 0.0,
) -> tuple[Canvas, list[Clad]]:
    """Draw all walls, the ground and the sky; `stray_m` is told in `flaws`.

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
        if surface.draw(canvas, camera, panel(wall, label, stray_m), cloth):
            walls.extend([(wall, cloth)] if wall.style else [])
    boxes = [block.corner_m for block in blocks]
    ground.lay(rng, canvas, camera, boxes, sun=sun)
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


@functools.lru_cache(maxsize=64)
def party_wall(seed: int) -> Gray:
    """Paint one tall piece of common brick."""
    rng = np.random.default_rng(seed)
    board = relief.blank(20.0, 22.0, px_per_m=16.0)
    masonry.clad(rng, board, material="stucco", albedo=float(rng.uniform(0.16, 0.34)))
    worn = masonry.weather(rng, board.albedo, px_per_m=16.0)
    return np.round(255 * worn**0.62).astype(np.uint8)


def faces(camera: Camera, wall: Wall, shape: tuple[int, int]) -> bool:
    """Say whether a wall turns its outside to the camera and is in view."""
    start, end = np.array(wall.start_m), np.array(wall.end_m)
    along = end - start
    out = np.array([along[1], -along[0]])
    if out @ (camera.eye_m[:2] - start) <= 0:
        return False
    return surface.bounds(camera, viewpoint.corners_m(wall), shape) is not None


def panel(wall: Wall, label: int, stray_m: float = 0.0) -> Panel:
    """Make a wall ready to draw; blank walls have nothing on them that could stray."""
    start, end = np.array([*wall.start_m, 0.0]), np.array([*wall.end_m, 0.0])
    axes = np.stack([end - start, [0.0, 0.0, wall.height_m]])
    uneven = flaws.stray(wall.style, stray_m) if wall.style and stray_m else None
    return Panel(start, axes, label, uneven)


def haze(rng: np.random.Generator, canvas: Canvas) -> None:
    """Let the city's air lighten what is far away."""
    reach = rng.uniform(250.0, 600.0)
    near = np.maximum(canvas.nearness, np.float32(1e-4))
    clear = np.exp(-1.0 / (near * np.float32(reach)))
    far = canvas.nearness > 0
    veiled = clear * canvas.tone + (1 - clear) * 205.0
    canvas.tone[far] = veiled[far]
