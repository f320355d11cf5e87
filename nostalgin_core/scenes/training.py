"""An endless supply of labelled photographs for the segmentation network."""

import functools
from collections.abc import Callable

import cv2
import numpy as np

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Category
from nostalgin_core.scenes import front
from nostalgin_core.scenes.photograph import photograph
from nostalgin_core.scenes.street import neighbourhood
from nostalgin_core.scenes.style import FrontStyle, style_for

POOL = 96  # painted fronts that training photos share, for painting is the slow part
STRETCH = 1.35  # how far a texture may be from its front's aspect
COARSE_PX_PER_M = 30.0
Thing = tuple[Category, Mask, bool]
Wardrobe = Callable[[FrontStyle], Gray | None]


def sample(
    rng: np.random.Generator,
    shape: tuple[int, int] = (840, 560),
    *,
    textures: list[Gray] | None = None,
) -> tuple[Gray, list[Thing]]:
    """Paint one photo of one lot of a new street.

    Returns the photo and its things as (category, visible mask, target). Where real
    straightened fronts are given as `textures`, half of the fronts wear one of them,
    stretched by no more than `STRETCH` and in a tone of their own.
    """
    hood = neighbourhood(rng, blocks=1)
    lots = [lot for lot in hood.blocks[0].lots if not lot.ruined]
    lot = lots[int(rng.integers(len(lots)))]
    photo = photograph(hood, lot, rng, shape=shape, wear=wardrobe(textures or []))
    facades = [facade for facade in photo.truth.facades if facade.visible.any()]
    things: list[Thing] = [("facade", each.visible, each.target) for each in facades]
    things.extend((each.category, each.mask, False) for each in photo.truth.occluders)
    return photo.image, things


def wardrobe(textures: list[Gray]) -> Wardrobe:
    """Make the choice of what a front wears: a real texture, or one of the pool's."""

    def wear(style: FrontStyle) -> Gray | None:
        rng = np.random.default_rng([style.seed, 77, style.wing])
        want = style.width_m / style.height_m
        if textures and rng.random() < 0.5:
            fits = [
                texture
                for texture in textures
                if fitting(texture.shape[1] / texture.shape[0], want)
            ]
            if fits:
                return retoned(rng, fits[int(rng.integers(len(fits)))])
        fits = [k for k in range(POOL) if fitting(pooled_aspect(k), want)]
        return pooled(fits[int(rng.integers(len(fits)))]) if fits else None

    return wear


def fitting(aspect: float, wanted: float) -> bool:
    """Say whether a texture's aspect is near enough to a front's."""
    return bool(1 / STRETCH < aspect / wanted < STRETCH)


def retoned(rng: np.random.Generator, texture: Gray) -> Gray:
    """Change a texture's contrast and lightness, and mirror it half of the time."""
    tone = np.arange(256) / 255.0
    curve = rng.uniform(0.7, 1.05) * tone ** rng.uniform(0.75, 1.3)
    table = np.clip(255 * (curve + rng.uniform(0.0, 0.08)), 0, 255).astype(np.uint8)
    made = cv2.LUT(texture, table)
    return np.ascontiguousarray(made[:, ::-1]) if rng.random() < 0.5 else made


def pool_style(number: int) -> FrontStyle:
    """Give the style of one front of the pool."""
    rng = np.random.default_rng([1940, number])
    sun = (float(rng.uniform(-0.7, 0.7)), 0.6, float(rng.uniform(-0.5, 0.8)))
    return style_for(rng, width_m=float(rng.uniform(6.0, 19.0)), sun=sun)


@functools.lru_cache(maxsize=POOL)
def pooled_aspect(number: int) -> float:
    """Give the width of a front of the pool over its height."""
    style = pool_style(number)
    return style.width_m / style.height_m


@functools.lru_cache(maxsize=POOL)
def pooled(number: int) -> Gray:
    """Paint one front of the pool, once."""
    return front.paint(pool_style(number), px_per_m=COARSE_PX_PER_M)
