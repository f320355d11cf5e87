"""What rises behind a street: towers in the haze, and tanks and chimneys on the roofs.

None of it is a front that anyone could straighten, so none of it is in the truth but as
`rest`.
"""

import numpy as np

from nostalgin_core.scenes import lens
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.props import UP, bar
from nostalgin_core.scenes.sprite import Patch, Sprite, cut_out
from nostalgin_core.scenes.street import PaintedBlock

HAZE = 214.0


def rise(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    blocks: list[PaintedBlock],
) -> list[Sprite]:
    """Set towers far off and furniture on the roofs in view."""
    found: list[Sprite | None] = []
    if rng.random() < 0.6:
        count = int(rng.integers(1, 4))
        found.extend(tower(rng, camera, shape) for _ in range(count))
    for block in blocks:
        for lot in block.lots:
            if rng.random() < 0.55:
                west, south = lot.footprint_m.min(axis=0)
                east, north = lot.footprint_m.max(axis=0)
                x = rng.uniform(west + 2.5, east - 2.5)
                y = rng.uniform(south + 2.5, north - 2.5)
                base = np.array([x, y, lot.height_m])
                found.append(on_roof(rng, camera, shape, base))
    return [sprite for sprite in found if sprite]


def facing(camera: Camera, base_m: np.ndarray) -> np.ndarray:
    """Give the level direction that runs to the right before the camera."""
    right = np.cross(base_m - camera.eye_m, UP)
    return right / np.linalg.norm(right)


def tower(
    rng: np.random.Generator, camera: Camera, shape: tuple[int, int]
) -> Sprite | None:
    """Raise a tower with setbacks, its windows a faint grid, far down the view."""
    depth, aside = rng.uniform(140, 420), rng.uniform(-0.45, 0.45)
    look = camera.rotation[2] * [1.0, 1.0, 0.0]
    look /= np.linalg.norm(look)
    right = np.cross(look, UP)
    base = camera.eye_m * [1.0, 1.0, 0.0] + depth * (look + aside * right)
    clear = float(np.exp(-depth / 190.0))
    tone = HAZE + clear * (rng.uniform(60, 150) - HAZE)
    parts: list[tuple[np.ndarray, float]] = []
    wide, low = rng.uniform(10, 24), 0.0
    high = rng.uniform(0.16, 0.5) * depth
    for share in np.sort(rng.uniform(0.4, 1.0, int(rng.integers(1, 4)))):
        top = high * share
        parts.append((block(-wide, wide * 0.35, low, top), tone))
        parts.append((block(wide * 0.35, wide, low, top), tone - 16 * clear))
        parts += grid(-wide, wide, low, top, tone - 34 * clear)
        wide, low = wide * rng.uniform(0.55, 0.8), top
    return raised(camera, shape, base, parts)


def block(left: float, right: float, low: float, high: float) -> np.ndarray:
    """Outline a rectangle in metres."""
    return np.array([[left, low], [right, low], [right, high], [left, high]])


def grid(
    left: float, right: float, low: float, high: float, tone: float
) -> list[tuple[np.ndarray, float]]:
    """Draw columns of windows."""
    return [
        (block(x, x + 1.2, up, up + 1.9), tone)
        for x in np.arange(left + 1.0, right - 1.0, 2.6)
        for up in np.arange(max(low, 8.0), high - 2.0, 3.6)
    ]


def on_roof(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    base_m: np.ndarray,
) -> Sprite | None:
    """Stand a water tank, a chimney or a stair bulkhead on a roof."""
    kind, tone = rng.random(), float(rng.uniform(45, 110))
    if kind < 0.3:
        parts = [
            (bar((x, 0.0), (x * 0.9, 2.6), 0.18), tone) for x in (-1.2, -0.4, 0.4, 1.2)
        ]
        parts += [
            (block(-1.5, 0.3, 2.5, 5.6), tone * 1.25),
            (block(0.3, 1.5, 2.5, 5.6), tone * 0.9),
            (np.array([[-1.6, 5.6], [1.6, 5.6], [0.0, 6.7]]), tone * 1.1),
        ]
    elif kind < 0.7:
        wide, high = rng.uniform(0.3, 0.7), rng.uniform(1.6, 3.2)
        parts = [(block(-wide, wide, -1.0, high), tone)]
        for x in np.arange(-wide + 0.15, wide, 0.4):
            parts.append((block(x, x + 0.2, high, high + 0.45), tone * 1.2))
    else:
        parts = [
            (block(-1.8, 0.6, -1.0, 2.7), tone * 1.3),
            (block(0.6, 1.6, -1.0, 2.7), tone),
        ]
    return raised(camera, shape, base_m, parts)


def raised(
    camera: Camera,
    shape: tuple[int, int],
    base_m: np.ndarray,
    parts: list[tuple[np.ndarray, float]],
) -> Sprite | None:
    """Stand flat outlines at a height, facing the camera."""
    depth = float(lens.see(camera, base_m[None])[0, 2])
    if not 4.0 < depth < 500.0:
        return None
    right = facing(camera, base_m)
    patches: list[Patch] = [
        (lens.project(camera, base_m + part[:, :1] * right + part[:, 1:] * UP), tone)
        for part, tone in parts
    ]
    return cut_out(None, depth, patches, shape, blur_px=0.7)
