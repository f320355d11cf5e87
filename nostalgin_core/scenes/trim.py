"""What is set on a wall: cornices, belt courses, quoins, fire escapes, wall signs."""

import numpy as np

from nostalgin_core.scenes.lettering import NAMES, NOTICES, write
from nostalgin_core.scenes.relief import Board, box, cut, stroke

IRON = 0.06


def cornice(
    rng: np.random.Generator,
    board: Board,
    *,
    width_m: float,
    top_m: float,
    high_m: float,
    albedo: float,
) -> None:
    """Crown a front with a frieze, brackets and a shelf that throws a shadow."""
    low = top_m - high_m
    box(board, (0.0, low, width_m, top_m), albedo=albedo * 0.9, relief_m=0.08)
    box(board, (0.0, low, width_m, low + 0.1), albedo=albedo, relief_m=0.16)
    pitch = rng.uniform(0.5, 1.6)
    count = max(2, round(width_m / pitch))
    wide = min(0.3, pitch * 0.35)
    for x in np.linspace(wide, width_m - wide, count):
        bracket = (x - wide / 2, low + 0.2, x + wide / 2, top_m - 0.25)
        box(board, bracket, albedo=albedo * 0.95, relief_m=0.42)
    shelf = rng.uniform(0.45, 0.7)
    box(board, (0.0, top_m - 0.32, width_m, top_m), albedo=albedo, relief_m=shelf)
    lip = (0.0, top_m - 0.12, width_m, top_m)
    box(board, lip, albedo=min(1.0, albedo * 1.15), relief_m=shelf + 0.1)


def parapet(board: Board, *, width_m: float, top_m: float, albedo: float) -> None:
    """End a front in a plain coping."""
    coping = (0.0, top_m - 0.22, width_m, top_m)
    box(board, coping, albedo=albedo, relief_m=0.14)
    band = (0.0, top_m - 1.15, width_m, top_m - 1.0)
    box(board, band, albedo=albedo * 0.95, relief_m=0.07)


def belt(board: Board, *, width_m: float, at_m: float, albedo: float) -> None:
    """Run a course of stone across the front."""
    box(board, (0.0, at_m, width_m, at_m + 0.3), albedo=albedo, relief_m=0.06)
    shelf = (0.0, at_m + 0.2, width_m, at_m + 0.3)
    box(board, shelf, albedo=albedo, relief_m=0.14)


def quoins(
    board: Board, *, width_m: float, low_m: float, high_m: float, albedo: float
) -> None:
    """Set long and short corner stones up both edges."""
    for k, low in enumerate(np.arange(low_m, high_m - 0.3, 0.4)):
        wide = 0.55 if k % 2 else 0.35
        for left in (0.0, width_m - wide):
            stone = (left, low, left + wide, low + 0.34)
            box(board, stone, albedo=albedo, relief_m=0.05)


def pilasters(
    board: Board,
    *,
    edges: np.ndarray,
    low_m: float,
    high_m: float,
    albedo: float,
) -> None:
    """Divide the bays by flat piers."""
    for x in edges:
        pier = (x - 0.22, low_m, x + 0.22, high_m)
        where = cut(board, *pier)
        board.albedo[where] = 0.5 * board.albedo[where] + 0.5 * albedo
        board.relief_m[where] = 0.12


def fire_escape(
    rng: np.random.Generator,
    board: Board,
    *,
    left_m: float,
    right_m: float,
    floors_m: np.ndarray,
) -> None:
    """Hang iron balconies on a front, with stairs between them."""
    out = 0.85
    for level, up in enumerate(floors_m):
        deck = (left_m, up - 0.12, right_m, up)
        box(board, deck, albedo=IRON, relief_m=out)
        for rail in (0.45, 0.9):
            stroke(
                board,
                (left_m, up + rail),
                (right_m, up + rail),
                wide_m=0.03,
                albedo=IRON,
                relief_m=out,
            )
        for x in np.arange(left_m, right_m + 0.05, 0.16):
            stroke(
                board, (x, up), (x, up + 0.9), wide_m=0.02, albedo=IRON, relief_m=out
            )
        if level + 1 < len(floors_m):
            stairs(board, (left_m, up), (right_m, float(floors_m[level + 1])), level)
    drop = left_m + 0.3 if rng.random() < 0.5 else right_m - 0.3
    first = float(floors_m[0])
    for x in (drop - 0.2, drop + 0.2):
        stroke(
            board,
            (x, first),
            (x, first - 2.0),
            wide_m=0.03,
            albedo=IRON,
            relief_m=out,
        )


def stairs(
    board: Board, low: tuple[float, float], high: tuple[float, float], level: int
) -> None:
    """Lay one flight between two balconies, falling left and right in turn."""
    run = min(2.0, high[0] - low[0] - 0.6)
    start = low[0] + 0.3 if level % 2 else high[0] - 0.3 - run
    ends = (start, start + run) if level % 2 else (start + run, start)
    for side in (0.0, 0.28):
        stroke(
            board,
            (ends[0], low[1] + side),
            (ends[1], high[1] + side - 0.1),
            wide_m=0.05,
            albedo=IRON,
            relief_m=0.5,
        )
    for share in np.linspace(0.05, 0.95, 12):
        x = ends[0] + share * (ends[1] - ends[0])
        up = low[1] + share * (high[1] - low[1])
        stroke(board, (x, up), (x, up + 0.26), wide_m=0.02, albedo=IRON, relief_m=0.5)


def wall_sign(
    rng: np.random.Generator,
    board: Board,
    *,
    width_m: float,
    low_m: float,
    high_m: float,
) -> None:
    """Fix a long board with a name between two storeys."""
    dark = rng.random() < 0.5
    name = str(rng.choice(NAMES))
    text = f"{name} {rng.choice(NOTICES)}" if rng.random() < 0.6 else name
    inset = rng.uniform(0.1, 0.25) * width_m
    face = (inset, low_m, width_m - inset, high_m)
    box(board, face, albedo=0.1 if dark else 0.75, relief_m=0.12)
    write(board, face, text, albedo=0.8 if dark else 0.1)


def bands(board: Board, width_m: float, *, floors: np.ndarray, albedo: float) -> None:
    """Stripe a front with flush courses of another stone, at sills and heads."""
    for floor in floors:
        for up, high in ((0.62, 0.2), (2.55, 0.24)):
            where = cut(
                board, 0.0, float(floor) + up, width_m, float(floor) + up + high
            )
            flush = np.abs(board.relief_m[where]) < 0.02
            board.albedo[where][flush] = albedo
            board.relief_m[where][flush] = 0.025


def panels(
    rng: np.random.Generator,
    board: Board,
    *,
    bays: np.ndarray,
    floors: np.ndarray,
    albedo: float,
) -> None:
    """Set carved panels below the windows of one or two storeys."""
    pitch = float(bays[1] - bays[0])
    wide = 0.42 * pitch
    for floor in rng.choice(floors[1:], size=min(2, len(floors) - 1), replace=False):
        for x in bays:
            low, high = float(floor) - 0.02, float(floor) + 0.5
            frame = (x - wide / 2, low, x + wide / 2, high)
            box(board, frame, albedo=albedo, relief_m=0.04)
            inner = (x - wide / 2 + 0.07, low + 0.07, x + wide / 2 - 0.07, high - 0.07)
            box(board, inner, albedo=albedo * 0.9, relief_m=0.0)
            swag(board, x, (low + high) / 2, wide * 0.3, albedo)


def swag(board: Board, x: float, up: float, reach: float, albedo: float) -> None:
    """Carve a garland, or something that looks like one across the street."""
    for turn in np.linspace(-1, 1, 9):
        at = (x + reach * float(turn), up - 0.1 + 0.14 * float(turn) ** 2)
        leaf = (at[0] - 0.05, at[1] - 0.04, at[0] + 0.05, at[1] + 0.05)
        box(board, leaf, albedo=albedo, relief_m=0.07)
    boss = (x - 0.06, up + 0.02, x + 0.06, up + 0.14)
    box(board, boss, albedo=albedo * 1.05, relief_m=0.09)
