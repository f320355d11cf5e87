"""Cars, taxis, trucks and buses of the 1930s, built of lengthwise slices.

A slice is an outline seen from the side, set at some distance across the car: wheels
and fenders outside, the narrow bonnet and the cabin inside. Drawn from the far side to
the near one they make a body.
"""

import numpy as np

from nostalgin_core.scenes import lens
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.sprite import Patch, Sprite, cut_out

# Outlines as rows of x along the car from the tail, z up, in metres.
SEDAN = np.array(
    [
        [0.05, 0.42],
        [0.0, 0.75],
        [0.25, 1.1],
        [0.75, 1.5],
        [1.25, 1.68],
        [2.2, 1.7],
        [2.62, 1.6],
        [2.95, 1.18],
        [3.5, 1.14],
        [4.25, 1.02],
        [4.42, 0.8],
        [4.4, 0.42],
    ]
)
BONNET = np.array(
    [
        [0.3, 0.4],
        [0.3, 0.9],
        [2.9, 1.18],
        [3.6, 1.14],
        [4.3, 1.03],
        [4.5, 0.75],
        [4.45, 0.38],
    ]
)
SIDE_GLASS = (
    np.array([[0.95, 1.16], [1.15, 1.45], [1.55, 1.55], [1.6, 1.16]]),
    np.array([[1.68, 1.16], [1.68, 1.56], [2.3, 1.57], [2.62, 1.42], [2.78, 1.16]]),
)
SCREEN = np.array([[2.6, 1.52], [2.88, 1.2], [2.95, 1.18], [2.66, 1.56]])
REAR = np.array([[0.55, 1.3], [0.85, 1.52], [0.8, 1.54], [0.5, 1.32]])
FENDERS = (
    np.array(
        [[0.1, 0.4], [0.12, 0.7], [0.4, 0.92], [0.85, 0.95], [1.25, 0.75], [1.45, 0.42]]
    ),
    np.array(
        [
            [2.75, 0.4],
            [3.05, 0.62],
            [3.35, 0.86],
            [3.8, 0.9],
            [4.3, 0.8],
            [4.5, 0.5],
            [4.45, 0.4],
        ]
    ),
)
BOARD = np.array([[1.3, 0.3], [1.3, 0.42], [3.0, 0.42], [3.0, 0.3]])
WHEELS = (0.85, 3.6)
VAN = np.array(
    [[0.0, 0.5], [0.0, 2.35], [0.1, 2.45], [3.3, 2.45], [3.4, 2.35], [3.4, 0.5]]
)
CAB = np.array(
    [[3.4, 0.5], [3.4, 1.95], [4.15, 1.95], [4.4, 1.35], [5.4, 1.25], [5.5, 0.5]]
)
CAB_GLASS = (np.array([[3.6, 1.35], [3.6, 1.8], [4.1, 1.8], [4.25, 1.35]]),)
TRUCK_WHEELS = (0.95, 4.7)


def park(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    middle_m: tuple[float, float],
    heading_deg: float,
) -> list[Sprite]:
    """Stand a car and its shadow on the road.

    The heading turns its nose from east towards north.
    """
    truck = rng.random() < 0.2
    length = 5.5 if truck else 4.5
    turn = np.deg2rad(heading_deg)
    along = np.array([np.cos(turn), np.sin(turn), 0.0])
    left = np.array([-np.sin(turn), np.cos(turn), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    base = np.array([*middle_m, 0.0])
    size = rng.uniform(0.94, 1.08)
    eye = camera.eye_m
    near_left = bool((eye - base) @ left > 0)

    def place(outline: np.ndarray, across: float) -> np.ndarray:
        x = (outline[:, :1] - length / 2) * size
        return base + x * along + across * size * left + outline[:, 1:] * size * up

    depth = float(lens.see(camera, base[None])[0, 2])
    if depth < 2.2:
        return []
    slices = (truck_slices if truck else sedan_slices)(rng)
    order = sorted(slices, key=lambda item: item[0] if near_left else -item[0])
    patches: list[Patch] = []
    for across, outline, tone in order:
        places = place(outline, across)
        if lens.see(camera, places)[:, 2].min() < 0.5:
            return []
        patches.append((lens.project(camera, places), tone))
    moving = rng.random() < 0.12
    body = cut_out(
        "vehicle",
        depth,
        patches,
        shape,
        drift_px=float(rng.uniform(4, 22)) if moving else 0.0,
        blur_px=0.7 if depth > 4 else 2.0,
    )
    print_m = wheel(0.0, 1.0) - [0.0, 1.0]
    pool = base + (0.55 * length * print_m[:, :1]) * along + print_m[:, 1:] * left
    shade = shadow_on_ground(camera, shape, pool, depth + 0.01)
    return [sprite for sprite in (shade, body) if sprite]


def shadow_on_ground(
    camera: Camera, shape: tuple[int, int], outline_m: np.ndarray, depth_m: float
) -> Sprite | None:
    """Darken the ground where something stands on it."""
    if lens.see(camera, outline_m)[:, 2].min() < 0.5:
        return None
    pixels = lens.project(camera, outline_m)
    soft = float(np.clip(0.06 * camera.focal_px / depth_m, 0.5, 14.0))
    return cut_out(None, depth_m, [(pixels, 22.0)], shape, blur_px=soft, opacity=0.62)


def wheel(middle_m: float, radius_m: float, *, up_m: float = 0.0) -> np.ndarray:
    """Outline a wheel, or something round, that rests at this height."""
    turn = np.linspace(0, 2 * np.pi, 18, endpoint=False)
    high = up_m + radius_m * (1 + np.sin(turn))
    return np.column_stack([middle_m + radius_m * np.cos(turn), high])


Slice = tuple[float, np.ndarray, float]


def sedan_slices(rng: np.random.Generator) -> list[Slice]:
    """List the slices of a car as distance across, outline, tone."""
    paint = float(rng.choice([26, 32, 40, 52, 70, 95, 140, 185]))
    top = min(paint * 1.3 + 46, 235.0)
    slices: list[Slice] = []
    for y in np.linspace(-0.55, 0.55, 12):
        slices.append((float(y), BONNET, paint * 0.9 + 20))
        slices.append((float(y), SEDAN, top if abs(y) < 0.5 else paint * 1.05))
        slices.append((float(y), SCREEN, 46.0))
        slices.append((float(y), REAR, 40.0))
        grille = abs(y) < 0.3
        if grille:
            bars = np.array([[4.44, 0.45], [4.46, 0.75], [4.3, 1.02], [4.27, 0.98]])
            slices.append((float(y), bars, 90.0 if int(y * 40) % 2 else 170.0))
    for sign in (-1, 1):
        slices.extend(sedan_side(rng, sign, paint, top))
    return slices


def sedan_side(
    rng: np.random.Generator, sign: int, paint: float, top: float
) -> list[Slice]:
    """List the slices of one side: body, glass, fenders, wheels, running board."""
    side: list[Slice] = []
    body = paint * (0.95 + 0.1 * rng.random())
    side.append((sign * 0.62, SEDAN, body))
    side.append((sign * 0.625, light_edge(SEDAN), top))
    side.extend(
        (sign * 0.63, glass, float(rng.uniform(30, 66))) for glass in SIDE_GLASS
    )
    seam = np.array([[1.63, 0.45], [1.63, 1.5], [1.655, 1.5], [1.655, 0.45]])
    side.append((sign * 0.632, seam, body * 0.6))
    belt = np.array([[0.6, 1.08], [0.6, 1.11], [4.2, 1.05], [4.2, 1.02]])
    side.append((sign * 0.634, belt, min(body * 1.3 + 20, 240.0)))
    for x in WHEELS:
        side.append((sign * 0.7, wheel(x, 0.37), 16.0))
        side.append((sign * 0.8, wheel(x, 0.35), 24.0))
    for y in np.linspace(0.62, 0.84, 6):
        for fender in FENDERS:
            tone = top if y < 0.8 else paint * 0.85
            side.append((sign * float(y), fender, tone))
        side.append((sign * float(y), BOARD, 30.0))
    for x in WHEELS:
        side.append((sign * 0.85, wheel(x, 0.34), 22.0))
        rim = wheel(x, 0.21, up_m=0.13)
        side.append((sign * 0.86, rim, float(rng.choice([70, 150, 190]))))
        hub = wheel(x, 0.09, up_m=0.25)
        side.append((sign * 0.865, hub, 200.0))
    for y in (0.48, 0.55, 0.6):
        lamp = wheel(4.2, 0.13, up_m=0.66)
        side.append((sign * y, lamp, 150.0 if y < 0.6 else 205.0))
    for x in (-0.05, 4.55):
        bumper = np.array([[x, 0.4], [x, 0.52], [x + 0.06, 0.52], [x + 0.06, 0.4]])
        side.extend((sign * float(y), bumper, 185.0) for y in np.arange(0.0, 0.8, 0.08))
    return side


def light_edge(outline: np.ndarray) -> np.ndarray:
    """Take the roof line of an outline as a thin band."""
    roof = outline[2:9]
    return np.concatenate([roof, (roof - [0.0, 0.07])[::-1]])


def truck_slices(rng: np.random.Generator) -> list[Slice]:
    """List the slices of a delivery truck."""
    paint = float(rng.choice([35, 60, 110, 165]))
    slices: list[Slice] = []
    for y in np.linspace(-0.9, 0.9, 14):
        slices.append((float(y), VAN, min(paint * 1.2 + 30, 235.0)))
        if abs(y) < 0.7:
            slices.append((float(y), CAB, min(paint * 1.1 + 25, 230.0)))
            screen = np.array([[4.12, 1.9], [4.38, 1.4], [4.42, 1.38], [4.18, 1.92]])
            slices.append((float(y), screen, 45.0))
    for sign in (-1, 1):
        slices.append((sign * 0.95, VAN, paint))
        panel = np.array([[0.25, 1.0], [0.25, 2.2], [3.15, 2.2], [3.15, 1.0]])
        slices.append((sign * 0.955, panel, min(paint * 1.12 + 8, 230.0)))
        for k in range(int(rng.integers(0, 9))):
            x = 0.5 + 0.3 * k
            bar = np.array([[x, 1.5], [x, 1.85], [x + 0.17, 1.85], [x + 0.17, 1.5]])
            slices.append((sign * 0.96, bar, 215.0 if paint < 100 else 40.0))
        slices.append((sign * 0.75, CAB, paint * 0.95))
        slices.extend((sign * 0.76, glass, 48.0) for glass in CAB_GLASS)
        for x in TRUCK_WHEELS:
            slices.append((sign * 0.86, wheel(x, 0.44), 18.0))
            slices.append((sign * 0.97, wheel(x, 0.42), 26.0))
            slices.append((sign * 0.98, wheel(x, 0.24, up_m=0.18), 110.0))
    return slices
