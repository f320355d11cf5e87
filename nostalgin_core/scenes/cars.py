"""Cars, taxis, trucks and buses of the 1930s, built of lengthwise slices.

A slice is an outline seen from the side, set at some distance across the car: wheels
and fenders outside, the narrow bonnet and the cabin inside. Drawn from the far side to
the near one they make a body.
"""

import numpy as np

from nostalgin_core.scenes import lens
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.people import smooth
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


def rounded(outline: np.ndarray) -> np.ndarray:
    """Round an outline as a press rounds sheet metal."""
    return smooth([(float(x), float(z)) for x, z in outline])


BODY, NOSE = rounded(SEDAN), rounded(BONNET)
WINGS = tuple(rounded(fender) for fender in FENDERS)


def wheel(middle_m: float, radius_m: float, *, up_m: float = 0.0) -> np.ndarray:
    """Outline a wheel, or something round, that rests at this height."""
    turn = np.linspace(0, 2 * np.pi, 18, endpoint=False)
    high = up_m + radius_m * (1 + np.sin(turn))
    return np.column_stack([middle_m + radius_m * np.cos(turn), high])


Slice = tuple[float, np.ndarray, float]


def sedan_slices(rng: np.random.Generator) -> list[Slice]:
    """List the slices of a car as distance across, outline, tone."""
    paint = float(rng.choice([24, 27, 31, 36, 44, 56, 74, 95, 125, 155]))
    top = min(paint * 1.3 + 50, 235.0)
    slices: list[Slice] = []
    for y in np.linspace(-0.58, 0.58, 16):
        crown = 1.0 - 0.4 * abs(y)
        slices.append((float(y), NOSE, paint * 0.8 + 34 * crown))
        slices.append((float(y), BODY, top * crown + paint * (1 - crown)))
        slices.append((float(y), SCREEN, 46.0))
        slices.append((float(y), REAR, 40.0))
        if abs(y) < 0.3:
            bars = np.array([[4.44, 0.45], [4.46, 0.75], [4.3, 1.02], [4.27, 0.98]])
            slices.append((float(y), bars, 90.0 if round(y * 26) % 2 else 165.0))
    for sign in (-1, 1):
        slices.extend(sedan_side(rng, sign, paint, top))
    return slices


def sedan_side(
    rng: np.random.Generator, sign: int, paint: float, top: float
) -> list[Slice]:
    """List the slices of one side: body, glass, fenders, wheels, running board."""
    side: list[Slice] = []
    body = paint * (0.95 + 0.1 * rng.random())
    side.append((sign * 0.62, BODY, body))
    # The side curves: light from above on its shoulder, dark towards the ground.
    low = np.array([[0.1, 0.42], [0.05, 0.72], [4.3, 0.72], [4.35, 0.42]])
    side.append((sign * 0.621, low, body * 0.72))
    shoulder = np.array([[0.35, 1.0], [0.3, 1.08], [2.9, 1.14], [2.9, 1.05]])
    side.append((sign * 0.622, shoulder, 0.5 * (body + top)))
    side.append((sign * 0.625, edge(BODY, 0.06), top))
    side.extend(
        (sign * 0.63, glass, float(rng.uniform(28, 60))) for glass in SIDE_GLASS
    )
    for seam in (0.95, 1.63, 2.72):
        line = np.array([[seam, 0.45], [seam, 1.16], [seam + 0.02, 1.16]])
        line = np.vstack([line, [seam + 0.02, 0.45]])
        side.append((sign * 0.632, line, body * 0.5))
    belt = np.array([[0.6, 1.09], [0.6, 1.11], [4.2, 1.06], [4.2, 1.04]])
    side.append((sign * 0.634, belt, min(body * 1.2 + 60, 240.0)))
    grip = np.array([[1.75, 1.0], [1.75, 1.03], [1.9, 1.03], [1.9, 1.0]])
    side.append((sign * 0.635, grip, 200.0))
    for x in WHEELS:
        side.append((sign * 0.7, wheel(x, 0.37), 14.0))
        side.append((sign * 0.8, wheel(x, 0.35), 22.0))
    for y in np.linspace(0.6, 0.86, 9):
        for wing in WINGS:
            bright = 1.0 - (float(y) - 0.6) / 0.26
            side.append((sign * float(y), wing, paint + (top - paint) * bright * 0.9))
        side.append((sign * float(y), BOARD, 28.0))
    for wing in WINGS:
        side.append((sign * 0.865, wing, paint * 0.82))
        side.append((sign * 0.866, edge(wing, 0.035), min(top + 25, 240.0)))
    side.extend(sedan_wheels(rng, sign))
    return side


def sedan_wheels(rng: np.random.Generator, sign: int) -> list[Slice]:
    """List the slices of the wheels, lamps and bumpers of one side."""
    side: list[Slice] = []
    rim = float(rng.choice([60, 90, 150, 190]))
    for x in WHEELS:
        side.append((sign * 0.87, wheel(x, 0.33), 20.0))
        side.append((sign * 0.875, wheel(x, 0.2, up_m=0.13), rim))
        side.append((sign * 0.877, wheel(x, 0.15, up_m=0.18), rim * 0.75))
        side.append((sign * 0.88, wheel(x, 0.08, up_m=0.25), 205.0))
    for y in (0.48, 0.55, 0.6):
        lamp = wheel(4.2, 0.13, up_m=0.66)
        side.append((sign * y, lamp, 150.0 if y < 0.6 else 205.0))
    for x in (-0.05, 4.55):
        bumper = np.array([[x, 0.4], [x, 0.52], [x + 0.06, 0.52], [x + 0.06, 0.4]])
        side.extend((sign * float(y), bumper, 185.0) for y in np.arange(0.0, 0.8, 0.08))
    return side


def edge(outline: np.ndarray, wide_m: float) -> np.ndarray:
    """Take the upper rim of an outline as a thin band."""
    middle = outline[:, 1].min() + 0.55 * np.ptp(outline[:, 1])
    rim = outline[outline[:, 1] > middle]
    return np.concatenate([rim, (rim - [0.0, wide_m])[::-1]])


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
