"""Soft things laid over hard walls, with every share of light accounted for.

Light from a sprite k reaches the film as

    w_k = a_k prod_{j nearer} (1 - a_j),      front i: [label = i] prod_j (1 - a_j),

and all these shares sum to one in every pixel. Shrinking and the lens's softness are
linear, so they are applied to picture and shares alike, and the sum stays one.
"""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.scenes import surface
from nostalgin_core.scenes.sprite import Sprite
from nostalgin_core.scenes.surface import Canvas

SUPER = 2  # samples a pixel and axis
SOFT_PX = 0.62  # the lens's point spread at 560 pixels' width
Plane = Float[np.ndarray, "_ _"]  # shapes differ: photo, supersampled, sprite


def composite(
    canvas: Canvas, sprites: list[Sprite]
) -> tuple[Plane, list[Plane], Plane]:
    """Lay sprites over the walls, near ones first.

    Returns the light, each sprite's share of it (the size of the sprite), and what is
    left for the walls.
    """
    through = np.ones_like(canvas.tone)
    light = np.zeros_like(canvas.tone)
    shares: list[Plane] = []
    for sprite in sprites:
        x, y = sprite.corner_px
        h, w = sprite.alpha.shape
        window = np.s_[y : y + h, x : x + w]
        wall = canvas.label[window] != surface.NOBODY
        hidden = wall & (canvas.nearness[window] > 1 / sprite.depth_m)
        alpha = np.where(hidden, np.float32(0), sprite.alpha)
        share = alpha * through[window]
        light[window] += share * sprite.tone
        through[window] *= 1 - alpha
        shares.append(share)
    return light + through * canvas.tone, shares, through


def shrink(plane: Plane) -> Plane:
    """Average the samples of each pixel."""
    h, w = plane.shape
    size = (w // SUPER, h // SUPER)
    return cv2.resize(plane, size, interpolation=cv2.INTER_AREA)


def soften(plane: Plane, shape: tuple[int, int]) -> Plane:
    """Apply the lens's point spread."""
    return cv2.GaussianBlur(plane, (0, 0), SOFT_PX * shape[1] / 560)


def spread(sprite: Sprite, share: Plane, shape: tuple[int, int]) -> Plane:
    """Shrink and soften one sprite's share, working only where it is."""
    pad = 8
    x, y = sprite.corner_px
    h, w = share.shape
    x0, y0 = max(0, x // SUPER - pad), max(0, y // SUPER - pad)
    x1 = min(shape[1], (x + w) // SUPER + 1 + pad)
    y1 = min(shape[0], (y + h) // SUPER + 1 + pad)
    fine = np.zeros((SUPER * (y1 - y0), SUPER * (x1 - x0)), np.float32)
    top, left = y - SUPER * y0, x - SUPER * x0
    fine[top : top + h, left : left + w] = share
    whole = np.zeros(shape, np.float32)
    whole[y0:y1, x0:x1] = soften(shrink(fine), shape)
    return whole
