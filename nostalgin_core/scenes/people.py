"""People on the pavement: hats, coats, legs, all in the photographer's haste."""

import numpy as np

from nostalgin_core.scenes import lens
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.sprite import Patch, Sprite, cut_out

Piece = tuple[np.ndarray, float]  # outline in metres (x, up), and its tone


def oval(x: float, z: float, wide: float, high: float) -> np.ndarray:
    """Outline an ellipse by its middle and half sizes."""
    turn = np.linspace(0, 2 * np.pi, 20, endpoint=False)
    return np.column_stack([x + wide * np.cos(turn), z + high * np.sin(turn)])


def smooth(points: list[tuple[float, float]]) -> np.ndarray:
    """Round the corners of a polygon by cutting them twice (Chaikin)."""
    shape = np.array(points)
    for _ in range(2):
        after = np.roll(shape, -1, axis=0)
        shape = np.stack([0.75 * shape + 0.25 * after, 0.25 * shape + 0.75 * after], 1)
        shape = shape.reshape(-1, 2)
    return shape


def figure(rng: np.random.Generator, *, pointing: float = 0.0) -> list[Piece]:
    """Draw one person 1.72 m tall, farthest piece first.

    `pointing` is -1 or 1 for an arm held out to the left or right.
    """
    woman = rng.random() < 0.35 and not pointing
    cloth = float(rng.choice([26, 34, 48, 66, 95, 135]))
    stockings = float(rng.choice([28, 45, 70])) if not woman else 125.0
    skin, felt = float(rng.uniform(130, 175)), float(rng.uniform(30, 120))
    stride = float(rng.uniform(-0.18, 0.18))
    hem = 0.48 if woman or rng.random() < 0.5 else 0.72
    lean = float(rng.uniform(-0.02, 0.02))
    return [
        *legs(stockings, hem=hem, stride=stride),
        *coat(cloth, hem=hem),
        *arms(cloth, skin, pointing=pointing),
        *front(rng, cloth, pointing=pointing),
        *face(skin, lean=lean),
        *(cap(felt, lean=lean) if woman else brim(felt, lean=lean)),
    ]


def legs(tone: float, *, hem: float, stride: float) -> list[Piece]:
    """Draw legs and shoes below a coat's hem."""
    parts: list[Piece] = []
    for side in (-1, 1):
        foot = 0.1 * side + stride * side
        leg = [(0.02 * side - 0.09, hem + 0.1), (0.02 * side + 0.09, hem + 0.1)]
        leg += [(foot + 0.06, 0.05), (foot - 0.06, 0.05)]
        parts.append((np.array(leg), tone))
        parts.append((oval(foot + 0.04, 0.04, 0.13, 0.05), 20.0))
    return parts


def coat(tone: float, *, hem: float) -> list[Piece]:
    """Draw a coat, its right half in the shade; a long one flares."""
    flare = 0.29 if hem < 0.6 else 0.23
    body = [(-flare, hem), (-0.2, 1.05), (-0.24, 1.4), (-0.1, 1.5), (0.1, 1.5)]
    body += [(0.24, 1.4), (0.2, 1.05), (flare, hem)]
    trunk = smooth(body)
    return [(trunk, tone), (trunk[trunk[:, 0] > 0.02], tone * 0.82)]


def arms(tone: float, skin: float, *, pointing: float) -> list[Piece]:
    """Draw two arms with their hands, one of them held out if it points."""
    parts: list[Piece] = []
    for side in (-1, 1):
        if side == pointing:
            arm = [(0.16 * side, 1.44), (0.75 * side, 1.33), (0.75 * side, 1.23)]
            arm += [(0.16 * side, 1.26)]
            parts.append((np.array(arm), tone * 1.15))
            parts.append((oval(0.8 * side, 1.28, 0.06, 0.05), skin))
        else:
            arm = [(0.17 * side, 1.45), (0.28 * side, 1.38), (0.3 * side, 0.9)]
            arm += [(0.2 * side, 0.85)]
            parts.append((smooth(arm), tone * (1.15 if side < 0 else 0.75)))
            parts.append((oval(0.25 * side, 0.84, 0.045, 0.07), skin))
    return parts


def front(rng: np.random.Generator, tone: float, *, pointing: float) -> list[Piece]:
    """Draw a sheet of paper in some hands, and the collar."""
    parts: list[Piece] = []
    if pointing or rng.random() < 0.2:
        sheet = [(0.02, 1.0), (0.22, 1.08), (0.3, 1.32), (0.1, 1.25)]
        parts.append((np.array(sheet) * [-pointing or 1.0, 1.0], 205.0))
    collar = np.array([(-0.06, 1.5), (0.0, 1.32), (0.06, 1.5)])
    return [*parts, (collar, 190.0 if rng.random() < 0.6 else tone * 1.3)]


def face(skin: float, *, lean: float) -> list[Piece]:
    """Draw a face, its right side in the shade."""
    return [
        (oval(lean, 1.6, 0.085, 0.115), skin),
        (oval(lean + 0.045, 1.58, 0.04, 0.09), skin * 0.72),
    ]


def cap(tone: float, *, lean: float) -> list[Piece]:
    """Draw a woman's close hat."""
    return [(oval(lean, 1.66, 0.11, 0.08), tone * 0.6)]


def brim(tone: float, *, lean: float) -> list[Piece]:
    """Draw a man's hat: crown and brim."""
    crown = [(-0.11, 1.65), (-0.1, 1.78), (0.1, 1.79), (0.11, 1.65)]
    return [
        (smooth([(x + lean, z) for x, z in crown]), tone),
        (oval(lean, 1.665, 0.175, 0.03), tone * 0.8),
    ]


def stand(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    feet_m: tuple[float, float],
    *,
    pointing: float = 0.0,
) -> Sprite | None:
    """Stand a person somewhere, facing the camera."""
    base = np.array([*feet_m, 0.0])
    depth = float(lens.see(camera, base[None])[0, 2])
    if depth < 1.4:
        return None
    right = np.cross(base - camera.eye_m, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    tall = rng.uniform(0.93, 1.06)
    up = np.array([0.0, 0.0, 1.0])
    mirror = 1.0 if pointing or rng.random() < 0.5 else -1.0
    patches: list[Patch] = [
        (
            lens.project(
                camera,
                base + tall * (mirror * part[:, :1] * right + part[:, 1:] * up),
            ),
            tone,
        )
        for part, tone in figure(rng, pointing=pointing)
    ]
    moving = rng.random() < 0.3 and not pointing
    size_px = camera.focal_px / depth
    return cut_out(
        "person",
        depth,
        patches,
        shape,
        drift_px=float(rng.uniform(0.03, 0.16)) * size_px if moving else 0.0,
        blur_px=float(np.clip(0.006 * size_px, 0.5, 4.0)),
        cloth=rng,
    )
