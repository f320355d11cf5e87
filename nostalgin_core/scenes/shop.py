"""The ground floor: shop windows under a sign, or a house door and its stoop."""

from itertools import pairwise

import cv2
import numpy as np

from nostalgin_core.scenes.lettering import legend, write
from nostalgin_core.scenes.relief import Board, box, cut
from nostalgin_core.scenes.window import WindowStyle, arch, paint_window

GLASS_M = -0.3


def shopfronts(
    rng: np.random.Generator, board: Board, *, width_m: float, high_m: float
) -> None:
    """Fill the ground floor with one to three shops and a way upstairs."""
    count = max(1, round(width_m / rng.uniform(5.0, 7.5)))
    stairs = 1.3 if width_m > 5.5 else 0.0
    pier = 0.35
    edges = np.linspace(0.2, width_m - 0.2 - stairs, count + 1)
    if stairs:
        door(rng, board, (width_m - stairs - 0.05, 0.0, width_m - 0.3, 2.7))
    shared = rng.random() < 0.4
    tone = rng.uniform(0.12, 0.75)
    for left, right in pairwise(edges):
        tone = tone if shared else rng.uniform(0.1, 0.75)
        shop(rng, board, (left + pier / 2, 0.0, right - pier / 2, high_m), tone=tone)
    ledge = (0.0, high_m - 0.12, width_m, high_m + 0.14)
    box(board, ledge, albedo=rng.uniform(0.3, 0.65), relief_m=0.28)


def shop(
    rng: np.random.Generator,
    board: Board,
    place: tuple[float, float, float, float],
    *,
    tone: float,
) -> None:
    """Draw one shop: bulkhead, panes with a dim inside, a recessed door, the sign."""
    left, low, right, high = place
    sign = high - rng.uniform(0.7, 1.1)
    trim = rng.uniform(0.1, 0.6)
    box(board, (left, low, right, sign), albedo=trim, relief_m=-0.05)
    for up, shade in ((0.5, 1.25), (0.06, 0.6), (2.58, 1.3)):
        ledge = (left, up, right, up + 0.05)
        box(board, ledge, albedo=min(trim * shade, 1.0), relief_m=0.03)
    wide = 1.0
    door_left = rng.choice(
        [left + 0.15, (left + right - wide) / 2, right - wide - 0.15]
    )
    panes = [(left + 0.12, door_left - 0.08), (door_left + wide + 0.08, right - 0.12)]
    for x0, x1 in panes:
        if x1 - x0 > 0.4:
            display(rng, board, (float(x0), 0.55, float(x1), 2.55))
    inside = (float(door_left), 0.0, float(door_left + wide), 2.4)
    box(board, inside, albedo=0.05, relief_m=-0.9)
    leaf = (inside[0] + 0.08, 0.25, inside[2] - 0.08, 2.2)
    box(board, leaf, albedo=0.12, relief_m=-0.85)
    transom = (left + 0.12, 2.68, right - 0.12, sign - 0.08)
    if transom[3] - transom[1] > 0.25:
        box(board, transom, albedo=rng.uniform(0.1, 0.3), relief_m=-0.15)
        for x in np.arange(transom[0], transom[2], rng.uniform(0.4, 0.9)):
            box(board, (x - 0.02, transom[1], x + 0.02, transom[3]), albedo=trim)
    face = (left - 0.1, sign, right + 0.1, high - 0.14)
    box(board, face, albedo=tone, relief_m=0.1)
    ink = 0.85 if tone < 0.4 else 0.08
    font = int(rng.choice([cv2.FONT_HERSHEY_DUPLEX, cv2.FONT_HERSHEY_TRIPLEX]))
    write(board, face, legend(rng), albedo=ink, font=font)


def display(
    rng: np.random.Generator, board: Board, place: tuple[float, float, float, float]
) -> None:
    """Draw one pane with goods and show cards behind it, and sky on the glass."""
    box(board, place, albedo=0.09, relief_m=GLASS_M)
    left, low, right, high = place
    for _ in range(int(rng.integers(2, 9))):
        x, up = rng.uniform(left, right - 0.15), rng.uniform(low, low + 1.1)
        size = rng.uniform(0.1, 0.5, 2)
        goods = (x, up, min(x + size[0], right), min(up + size[1], high))
        box(board, goods, albedo=float(rng.uniform(0.08, 0.5)))
    if rng.random() < 0.5:
        x = rng.uniform(left, max(left + 0.05, right - 0.8))
        card = (x, high - 0.6, min(x + 0.7, right), high - 0.2)
        box(board, card, albedo=0.6)
        write(board, card, legend(rng), albedo=0.1)
    if rng.random() < 0.5 and right - left > 0.8:
        gilt = (left + 0.1, high - 0.75, right - 0.1, high - 0.3)
        write(board, gilt, legend(rng), albedo=0.8)
    for x in np.arange(left + 1.3, right - 0.5, 1.3):
        box(board, (x - 0.02, low, x + 0.02, high), albedo=0.45, relief_m=GLASS_M)
    glass = board.albedo[cut(board, *place)]
    if glass.size:
        ramp = np.linspace(0.14, 0.0, glass.shape[0], dtype=np.float32)
        glass[:] = 0.85 * glass + ramp[:, None] * rng.uniform(0.2, 1.0)


def door(
    rng: np.random.Generator, board: Board, place: tuple[float, float, float, float]
) -> None:
    """Draw a house door of two leaves with a light above it."""
    left, low, right, high = place
    box(board, place, albedo=0.06, relief_m=-0.35)
    wood = rng.uniform(0.1, 0.3)
    middle = (left + right) / 2
    for x0, x1 in ((left + 0.06, middle - 0.02), (middle + 0.02, right - 0.06)):
        box(board, (x0, low, x1, high - 0.6), albedo=wood, relief_m=-0.3)
        box(board, (x0 + 0.1, low + 1.0, x1 - 0.1, high - 0.75), albedo=0.07)
        box(board, (x0 + 0.1, low + 0.2, x1 - 0.1, low + 0.85), albedo=wood * 0.8)


def parlour(
    rng: np.random.Generator,
    board: Board,
    *,
    bays: np.ndarray,
    wide_m: float,
    high_m: float,
    style: WindowStyle,
) -> None:
    """Give a house its stoop, its door and its parlour windows."""
    entry = int(rng.integers(0, 2)) * (len(bays) - 1)
    floor = rng.uniform(0.6, 1.3)
    for bay, x in enumerate(bays):
        if bay == entry:
            door(rng, board, (x - 0.7, floor, x + 0.7, high_m - 0.5))
            portal(board, (x - 0.95, floor, x + 0.95, high_m - 0.45), style=style)
            steps(board, x, floor)
        else:
            place = (x - wide_m / 2, floor + 0.7, x + wide_m / 2, high_m - 0.6)
            paint_window(rng, board, place, style=style)
            cellar = (x - wide_m / 2, 0.1, x + wide_m / 2, floor - 0.1)
            box(board, cellar, albedo=0.08, relief_m=-0.2)


def portal(
    board: Board, place: tuple[float, float, float, float], *, style: WindowStyle
) -> None:
    """Frame a door with pilasters and a ledge."""
    left, low, right, high = place
    for x0, x1 in ((left, left + 0.2), (right - 0.2, right)):
        box(board, (x0, low, x1, high), albedo=style.stone, relief_m=0.12)
    ledge = (left - 0.1, high, right + 0.1, high + 0.3)
    box(board, ledge, albedo=style.stone, relief_m=0.3)


def steps(board: Board, middle_m: float, floor_m: float) -> None:
    """Lead down from a door to the pavement."""
    count = max(2, round(floor_m / 0.18))
    rise = floor_m / count
    for k in range(count):
        tread = (middle_m - 0.8, floor_m - (k + 1) * rise, middle_m + 0.8)
        out = 0.12 + 0.1 * k
        box(board, (*tread, floor_m - k * rise), albedo=0.3, relief_m=out)
        nose = (tread[0], floor_m - k * rise - 0.05, tread[2], floor_m - k * rise)
        box(board, nose, albedo=0.5)
    for x in (middle_m - 0.85, middle_m + 0.8):
        box(board, (x, 0.0, x + 0.06, floor_m + 0.8), albedo=0.08, relief_m=0.2)


def arcade(
    rng: np.random.Generator, board: Board, *, bays: np.ndarray, high_m: float
) -> None:
    """Open the ground floor of a loft or bank in tall round arches."""
    pitch = float(bays[1] - bays[0]) if len(bays) > 1 else 3.0
    wide = min(0.72 * pitch, 3.2)
    for x in bays:
        place = (x - wide / 2, 0.4, x + wide / 2, high_m - wide / 2 - 0.5)
        arch(board, place, rise=wide / 2, albedo=0.1, relief_m=-0.4)
        box(board, place, albedo=0.1, relief_m=-0.4)
        for k in range(1, 4):
            bar = x - wide / 2 + wide * k / 4
            box(board, (bar - 0.03, 0.4, bar + 0.03, place[3]), albedo=0.4)
        for up in (1.3, 2.5, place[3]):
            box(board, (place[0], up - 0.05, place[2], up + 0.05), albedo=0.4)
    entry = float(rng.choice(bays))
    door(rng, board, (entry - 0.8, 0.0, entry + 0.8, 2.9))
