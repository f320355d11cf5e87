"""Windows: the opening in its reveal, sashes, glass, blinds, curtains, sill, head."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from nostalgin_core.scenes.relief import Board, box, cut, outline

Head = Literal["flat", "stone", "keystone", "segment", "hood", "arch"]
REVEAL_M = -0.18
FRAME_M = 0.06


@dataclass(frozen=True, slots=True)
class WindowStyle:
    """What all windows of one storey have in common."""

    head: Head
    lights: tuple[int, int]  # panes across and down in one sash
    frame: float  # albedo of the sashes
    stone: float  # albedo of sill and head
    dressed: float  # share of windows with blinds or curtains


def paint_window(
    rng: np.random.Generator,
    board: Board,
    place: tuple[float, float, float, float],
    *,
    style: WindowStyle,
) -> None:
    """Draw one double-hung window; place is left, low, right, high of the opening."""
    left, low, right, high = place
    surround(board, place, style=style)
    box(board, place, albedo=0.16, relief_m=REVEAL_M)
    if style.head == "arch":
        rise = (right - left) / 2
        arch(board, place, rise=rise, albedo=0.16, relief_m=REVEAL_M)
    elif style.head == "segment":
        arch(board, place, rise=0.16, albedo=0.16, relief_m=REVEAL_M)
    inner = (left + 0.03, low + 0.03, right - 0.03, high - 0.03)
    box(board, inner, albedo=style.frame, relief_m=REVEAL_M + 0.03)
    middle = (low + high) / 2 + rng.choice([0.0, 0.0, 0.0, 0.05])
    lift = rng.uniform(0.15, 0.6) if rng.random() < 0.12 else 0.0
    sash = (left + 0.03 + FRAME_M, right - 0.03 - FRAME_M)
    pane(
        rng,
        board,
        (sash[0], middle + FRAME_M / 2, sash[1], high - 0.03 - FRAME_M),
        style=style,
        upper=True,
    )
    bottom = low + 0.03 + FRAME_M
    pane(
        rng,
        board,
        (sash[0], bottom + lift, sash[1], middle - FRAME_M / 2),
        style=style,
        upper=False,
    )
    if lift:
        box(board, (sash[0], bottom, sash[1], bottom + lift - FRAME_M), albedo=0.05)
    dress(rng, board, (sash[0], bottom, sash[1], high - 0.1), style=style)


def pane(
    rng: np.random.Generator,
    board: Board,
    place: tuple[float, float, float, float],
    *,
    style: WindowStyle,
    upper: bool,
) -> None:
    """Draw the glass of one sash, dark with some sky in it, and its glazing bars."""
    where = cut(board, *place)
    h, w = board.albedo[where].shape
    if h == 0 or w == 0:
        return
    sky = rng.uniform(0.0, 0.14) * (1.3 if upper else 0.8)
    ramp = np.linspace(sky, 0.25 * sky, h, dtype=np.float32)[:, None]
    tilt = np.linspace(-1, 1, w, dtype=np.float32) * rng.uniform(-0.02, 0.02)
    board.albedo[where] = np.clip(0.07 + ramp + tilt, 0.02, 1.0)
    board.relief_m[where] = REVEAL_M
    left, low, right, high = place
    across, down = style.lights
    for k in range(1, across):
        x = left + (right - left) * k / across
        box(board, (x - 0.015, low, x + 0.015, high), albedo=style.frame)
    for k in range(1, down):
        up = low + (high - low) * k / down
        box(board, (left, up - 0.015, right, up + 0.015), albedo=style.frame)


def dress(
    rng: np.random.Generator,
    board: Board,
    place: tuple[float, float, float, float],
    *,
    style: WindowStyle,
) -> None:
    """Hang a blind, half drawn, or curtains behind the glass, or nothing."""
    if rng.random() > style.dressed:
        return
    glass = board.albedo[cut(board, *place)]
    if glass.size == 0:
        return
    h, w = glass.shape
    behind = np.zeros((h, w), np.float32)
    cloth = rng.uniform(0.3, 0.72)
    if rng.random() < 0.7:
        behind[: int(h * np.clip(rng.normal(0.42, 0.2), 0.08, 1.0))] = cloth
    else:
        x = np.abs(np.linspace(-1, 1, w))[None, :]
        y = np.linspace(0, 1, h)[:, None]
        folds = 1 + 0.12 * np.sin(x * rng.uniform(25, 45))
        behind[:] = np.where(x > 0.35 + 0.4 * y * rng.uniform(0.2, 1), cloth * folds, 0)
    hung = (behind > 0) & (glass < style.frame - 0.04)
    glass[hung] = (0.25 * glass + 0.75 * behind)[hung]


def surround(
    board: Board, place: tuple[float, float, float, float], *, style: WindowStyle
) -> None:
    """Set the sill and the head."""
    left, low, right, high = place
    wide = 0.1
    box(
        board,
        (left - wide, low - 0.14, right + wide, low),
        albedo=style.stone,
        relief_m=0.09,
    )
    if style.head in ("stone", "keystone"):
        lintel = (left - wide, high, right + wide, high + 0.26)
        box(board, lintel, albedo=style.stone, relief_m=0.04)
    if style.head == "keystone":
        x = (left + right) / 2
        key = np.array(
            [
                [x - 0.1, high - 0.02],
                [x + 0.1, high - 0.02],
                [x + 0.17, high + 0.38],
                [x - 0.17, high + 0.38],
            ]
        )
        outline(board, key, albedo=style.stone * 1.05, relief_m=0.08)
    if style.head == "hood":
        for x in (left - 0.12, right + 0.04):
            box(
                board,
                (x, low, x + 0.08, high + 0.1),
                albedo=style.stone,
                relief_m=0.05,
            )
        box(
            board,
            (left - 0.14, high, right + 0.14, high + 0.2),
            albedo=style.stone * 0.92,
            relief_m=0.05,
        )
        hood = (left - 0.22, high + 0.2, right + 0.22, high + 0.36)
        box(board, hood, albedo=style.stone, relief_m=0.24)
    if style.head in ("arch", "segment"):
        rise = (right - left) / 2 if style.head == "arch" else 0.16
        grown = (left - 0.2, low, right + 0.2, high)
        arch(board, grown, rise=rise + 0.22, albedo=style.stone, relief_m=0.03)


def arch(
    board: Board,
    place: tuple[float, float, float, float],
    *,
    rise: float,
    albedo: float,
    relief_m: float,
) -> None:
    """Round the top of an opening by half an ellipse."""
    left, _, right, high = place
    turn = np.linspace(0, np.pi, 24)
    x = (left + right) / 2 + (right - left) / 2 * np.cos(turn)
    rim = np.column_stack([x, high + rise * np.sin(turn)])
    outline(board, rim, albedo=albedo, relief_m=relief_m)
