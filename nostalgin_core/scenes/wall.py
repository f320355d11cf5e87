"""What walls are made of: brick, ashlar, stucco, and the soot on them."""

from typing import Literal

import numpy as np
from jaxtyping import Float

from nostalgin_core.scenes import grain
from nostalgin_core.scenes.relief import Board

Plane = Float[np.ndarray, "h w"]
Material = Literal["brick", "ashlar", "stucco"]


def cells(
    rng: np.random.Generator,
    shape: tuple[int, int],
    *,
    size_px: tuple[float, float],
    joint_px: float,
) -> tuple[Plane, Plane]:
    """Lay stones of one size in a running bond.

    Returns each pixel's stone as a random number of deviation one, and the joints,
    0 to 1.
    """
    wide, high = size_px
    y = np.arange(shape[0], dtype=np.float32)[::-1]
    x = np.arange(shape[1], dtype=np.float32)
    course = np.floor(y / high).astype(np.intp)
    shift = np.where(course % 2, 0.5, 0.0).astype(np.float32)
    along = x[None, :] / wide + shift[:, None]
    stone = np.floor(along).astype(np.intp)
    table = rng.standard_normal((course.max() + 1, stone.max() + 1), dtype=np.float32)
    bed = np.clip(joint_px - np.minimum(y % high, high - y % high), 0.0, 1.0)
    head = np.minimum(along % 1.0, 1.0 - along % 1.0) * wide
    joints = np.maximum(bed[:, None], np.clip(joint_px - head, 0.0, 1.0))
    return table[course[:, None], stone], joints


def clad(
    rng: np.random.Generator, board: Board, *, material: Material, albedo: float
) -> None:
    """Cover the whole drawing with one material."""
    shape, scale = board.albedo.shape, board.px_per_m
    fine = rng.standard_normal(shape, dtype=np.float32)
    if material == "brick":
        tint, joints = cells(
            rng, shape, size_px=(0.21 * scale, 0.075 * scale), joint_px=0.012 * scale
        )
        pale = 0.25 if albedo < 0.45 else -0.2
        tone = 1.0 + 0.075 * tint + 1.2 * pale * joints + 0.04 * fine
    elif material == "ashlar":
        tint, joints = cells(
            rng, shape, size_px=(1.1 * scale, 0.45 * scale), joint_px=0.02 * scale
        )
        tone = 1.0 + 0.035 * tint - 0.22 * joints + 0.03 * fine
    else:
        tone = 1.0 + 0.03 * fine
    tone = tone + 0.05 * grain.cloud(rng, shape, scale_px=2.0 * scale)
    board.albedo[:] = albedo * np.clip(tone, 0.3, 1.6)


def weather(rng: np.random.Generator, lit: Plane, *, px_per_m: float) -> Plane:
    """Let soot and water run down a finished front."""
    shape = lit.shape
    run = grain.streaks(rng, shape, wide_px=0.18 * px_per_m, long_px=3.0 * px_per_m)
    soot = grain.cloud(rng, shape, scale_px=3.0 * px_per_m)
    tone = 1.0 - 0.04 * np.maximum(run, 0.0) + 0.035 * soot
    low = np.linspace(0.0, 1.0, shape[0], dtype=np.float32)[:, None]
    tone = tone * (1.0 - 0.06 * low)
    return np.clip(lit * tone, 0.0, 1.0).astype(np.float32)
