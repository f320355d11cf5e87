"""The number board, lamp posts, trees, hydrants, hanging signs and awnings."""

from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np

from nostalgin_core.records import Category
from nostalgin_core.scenes import lens
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.lettering import NAMES, TRADES, lettered
from nostalgin_core.scenes.people import oval
from nostalgin_core.scenes.sprite import Patch, Sprite, cut_out, pasted

UP = np.array([0.0, 0.0, 1.0])
BOARD_M = (0.92, 0.18)  # the number board without its arrow
ARROW_M = 0.11


def bar(
    start: tuple[float, float], end: tuple[float, float], wide: float
) -> np.ndarray:
    """Outline a straight bar in metres (x, up)."""
    a, b = np.array(start), np.array(end)
    along = (b - a) / max(float(np.linalg.norm(b - a)), 1e-6)
    side = np.array([-along[1], along[0]]) * wide / 2
    return np.array([a - side, b - side, b + side, a + side])


def upright(
    category: Category,
    camera: Camera,
    shape: tuple[int, int],
    feet_m: tuple[float, float],
    parts: list[tuple[np.ndarray, float]],
) -> Sprite | None:
    """Stand flat outlines in metres on the ground, facing the camera."""
    base = np.array([*feet_m, 0.0])
    depth = float(lens.see(camera, base[None])[0, 2])
    if depth < 1.5:
        return None
    right = np.cross(base - camera.eye_m, UP)
    right /= np.linalg.norm(right)
    patches: list[Patch] = []
    for part, tone in parts:
        places = base + part[:, :1] * right + part[:, 1:] * UP
        if lens.see(camera, places)[:, 2].min() < 0.3:
            return None
        patches.append((lens.project(camera, places), tone))
    return cut_out(category, depth, patches, shape, blur_px=0.5)


def lamp_post(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    feet_m: tuple[float, float],
) -> Sprite | None:
    """Stand a lamp with a crook."""
    iron, side = float(rng.uniform(38, 70)), float(rng.choice([-1, 1]))
    turn = np.linspace(np.pi, 0.0, 12)
    bend = [(side * 0.6 * (1 + np.cos(t)), 6.3 + 0.8 * np.sin(t)) for t in turn]
    parts = [
        (bar((0.0, 0.0), (0.0, 1.1), 0.3), iron),
        (bar((0.0, 1.0), (0.0, 4.0), 0.17), iron),
        (bar((0.0, 4.0), (0.0, 6.3), 0.12), iron),
    ]
    parts += [(bar(p, q, 0.08), iron) for p, q in pairwise(bend)]
    parts.append((bar((side * 1.2, 6.3), (side * 1.2, 6.0), 0.1), iron))
    parts.append((oval(side * 1.2, 5.85, 0.2, 0.22), 225.0))
    return upright("other", camera, shape, feet_m, parts)


def hydrant(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    feet_m: tuple[float, float],
) -> Sprite | None:
    """Stand a hydrant, a mailbox or a parking post."""
    if rng.random() < 0.5:
        parts = [
            (bar((0.0, 0.0), (0.0, 0.75), 0.26), 45.0),
            (oval(0.0, 0.78, 0.15, 0.12), 60.0),
            (bar((-0.2, 0.5), (0.2, 0.5), 0.12), 55.0),
        ]
    else:
        parts = [
            (bar((0.0, 0.0), (0.0, 2.4), 0.06), 60.0),
            (bar((0.0, 2.0), (0.0, 2.55), 0.4), 190.0),
            (bar((-0.13, 2.35), (0.13, 2.35), 0.06), 40.0),
        ]
    return upright("other", camera, shape, feet_m, parts)


def tree(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    feet_m: tuple[float, float],
) -> Sprite | None:
    """Grow a young street tree, bare or in leaf."""
    leafy = rng.random() < 0.5
    parts: list[tuple[np.ndarray, float]] = []
    leaves: list[tuple[np.ndarray, float]] = []

    def grow(start: tuple[float, float], angle: float, long: float, order: int) -> None:
        end = (start[0] + long * np.sin(angle), start[1] + long * np.cos(angle))
        wide = max(0.018, 0.16 * 0.6 ** (5 - order))
        parts.append((bar(start, end, wide), float(rng.uniform(40, 70))))
        if order == 0 or (leafy and order <= 2):
            for _ in range(3 if leafy else 0):
                at = rng.normal(0, 0.3, 2)
                leaf = oval(end[0] + at[0], end[1] + at[1], *rng.uniform(0.12, 0.34, 2))
                leaves.append((leaf, float(rng.uniform(45, 125))))
        if order == 0:
            return
        for turn in (-1, 1):
            bend = angle + turn * rng.uniform(0.2, 0.6)
            grow(end, bend, long * rng.uniform(0.6, 0.85), order - 1)

    grow((0.0, 0.0), float(rng.normal(0, 0.04)), float(rng.uniform(1.5, 2.1)), 5)
    return upright("vegetation", camera, shape, feet_m, parts + leaves)


def number_board(
    camera: Camera,
    shape: tuple[int, int],
    middle_m: np.ndarray,
    *,
    text: str,
    arrow: float,
    roll_deg: float,
) -> list[Sprite]:
    """Stand the archive's board in the street, its white arrow over it.

    `arrow` is where the arrow sits along the board, -1 to 1. Returns the pole (which
    is `other`) and the board with its arrow.
    """
    right = np.cross(middle_m - camera.eye_m, UP)
    right /= np.linalg.norm(right)
    turn = np.deg2rad(roll_deg)
    u, v = (
        np.cos(turn) * right + np.sin(turn) * UP,
        np.cos(turn) * UP - np.sin(turn) * right,
    )
    tone, alpha = board_picture(text, arrow)
    wide, high = BOARD_M[0], BOARD_M[1] + ARROW_M
    origin = middle_m - u * wide / 2 - v * BOARD_M[1] / 2
    axes = np.stack([u * wide, v * high])
    board = pasted("placard", camera, shape, (origin, axes), (tone, alpha), blur_px=0.8)
    feet = (float(middle_m[0]), float(middle_m[1]))
    pole = upright(
        "other",
        camera,
        shape,
        feet,
        [(bar((0.0, 0.0), (0.0, float(middle_m[2])), 0.022), 92.0)],
    )
    if pole and board:
        pole = replace(pole, depth_m=board.depth_m + 0.02)
    return [sprite for sprite in (pole, board) if sprite]


def board_picture(text: str, arrow: float) -> tuple[np.ndarray, np.ndarray]:
    """Draw the board: white figures on black, a light rim, the arrow above."""
    scale = 420
    wide, low = round(BOARD_M[0] * scale), round(BOARD_M[1] * scale)
    tip = round(ARROW_M * scale)
    tone = np.full((low + tip, wide), 225.0, np.float32)
    alpha = np.zeros_like(tone)
    alpha[tip:] = 1.0
    tone[tip:] = 170.0
    tone[tip + 3 : -3, 3:-3] = 24.0
    face = tone[tip + 3 : -3, 3:-3]
    font = cv2.FONT_HERSHEY_SIMPLEX
    text = text.replace(" -", "  - ").replace(" M", "   M")
    (long, tall), _ = cv2.getTextSize(text, font, 1.0, 2)
    fit = min(0.62 * face.shape[0] / tall, 0.9 * face.shape[1] / long)
    ink = lettered(text, face.shape, font=font, scale=fit, bold_px=1.4)
    face[:] = face * (1 - ink) + 232 * ink
    x = wide / 2 * (1 + 0.6 * arrow)
    triangle = np.array([[x - 30, tip], [x + 30, tip], [x, 0]])
    cv2.fillPoly(alpha, [np.round(triangle).astype(np.int32)], 1.0)
    return tone, alpha


def hanging_sign(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    foot_m: np.ndarray,
    out: np.ndarray,
) -> Sprite | None:
    """Hang a sign at right angles to a front, its words across or one under another."""
    tall = rng.random() < 0.5
    wide, high = (0.8, rng.uniform(2.0, 4.0)) if tall else (1.5, rng.uniform(0.6, 1.0))
    dark = rng.random() < 0.6
    scale = 70
    tone = np.full((round(high * scale), round(wide * scale)), 34.0 if dark else 205.0)
    word = str(rng.choice([*NAMES, *TRADES])).split()[0]
    ink_tone = 222.0 if dark else 30.0
    lines = list(word) if tall else [word]
    step = tone.shape[0] / len(lines)
    for k, line in enumerate(lines):
        field = tone[round(k * step) : round((k + 1) * step)]
        (long, text_high), _ = cv2.getTextSize(line, cv2.FONT_HERSHEY_DUPLEX, 1.0, 1)
        fit = min(0.75 * field.shape[0] / text_high, 0.8 * field.shape[1] / long)
        ink = lettered(line, field.shape, font=cv2.FONT_HERSHEY_DUPLEX, scale=fit)
        field[:] = field * (1 - ink) + ink_tone * ink
    tone[:3] = tone[-3:] = tone[:, :3] = tone[:, -3:] = 120.0
    start = foot_m + 0.25 * out
    u = out * wide
    facing = float(np.cross(u, UP * high) @ (camera.eye_m - start))
    if facing < 0:
        start, u = start + u, -u
    axes = np.stack([u, UP * high])
    sheet = (tone, np.ones_like(tone))
    return pasted("other", camera, shape, (start, axes), sheet, blur_px=0.5)


def awning(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    left_m: np.ndarray,
    right_m: np.ndarray,
    *,
    out: np.ndarray,
) -> Sprite | None:
    """Let a striped or plain awning down over a shop window."""
    fall, reach = float(rng.uniform(0.7, 1.1)), float(rng.uniform(0.9, 1.5))
    high = float(rng.uniform(3.0, 3.3))
    wide = float(np.linalg.norm(right_m - left_m))
    tone = np.full((48, max(16, round(40 * wide))), rng.uniform(95, 190), np.float32)
    if rng.random() < 0.6:
        stripe = (np.arange(tone.shape[1]) // 10) % 2 == 0
        tone[:, stripe] = rng.uniform(45, 90)
    tone[:] *= np.linspace(1.1, 0.85, 48, dtype=np.float32)[:, None]
    tone[-9:] *= 0.72
    alpha = np.ones_like(tone)
    scallop = np.abs(np.sin(np.arange(tone.shape[1]) * np.pi / 10))
    alpha[-3:, scallop < 0.4] = 0.0
    foot = left_m + reach * out + (high - fall) * UP
    axes = np.stack([right_m - left_m, fall * UP - reach * out])
    return pasted("other", camera, shape, (foot, axes), (tone, alpha), blur_px=0.5)
