"""The style of a front: what kind of house it is, and the sizes that suit it."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from nostalgin_core.scenes import wall
from nostalgin_core.scenes.window import Head, WindowStyle

Kind = Literal["rowhouse", "tenement", "loft", "office", "hotel", "taxpayer"]
KINDS: tuple[Kind, ...] = (
    "rowhouse",
    "tenement",
    "loft",
    "office",
    "hotel",
    "taxpayer",
)
STOREYS: dict[Kind, tuple[int, int]] = {
    "rowhouse": (3, 5),
    "tenement": (4, 6),
    "loft": (5, 8),
    "office": (6, 10),
    "hotel": (5, 9),
    "taxpayer": (1, 2),
}
STOREY_M: dict[Kind, float] = {
    "rowhouse": 3.4,
    "tenement": 3.2,
    "loft": 3.7,
    "office": 3.6,
    "hotel": 3.3,
    "taxpayer": 3.6,
}


@dataclass(frozen=True, slots=True)
class FrontStyle:
    """All that one front's picture depends on: same style, same texture."""

    seed: int
    kind: Kind
    width_m: float
    storeys: int
    base_m: float  # height of the ground floor
    crown_m: float  # height of what stands above the last storey
    material: wall.Material
    albedo: float
    shops: bool
    sun: tuple[float, float, float]  # right, up, out of the wall
    wing: int = 0  # the fronts of one corner building differ in this and in width

    @property
    def height_m(self) -> float:
        """From the pavement to the top of the cornice."""
        above = (self.storeys - 1) * STOREY_M[self.kind]
        return self.base_m + above + self.crown_m


def style_for(
    rng: np.random.Generator,
    *,
    width_m: float,
    kind: Kind | None = None,
    sun: tuple[float, float, float] = (-0.5, 0.6, 0.62),
) -> FrontStyle:
    """Choose a style that suits the width."""
    chosen = kind or KINDS[int(rng.choice(6, p=[0.22, 0.28, 0.2, 0.1, 0.12, 0.08]))]
    least, most = STOREYS[chosen]
    stone = rng.random()
    material: wall.Material = "brick"
    if chosen in ("office", "hotel", "loft") and stone < 0.35:
        material = "ashlar"
    elif stone > 0.8:
        material = "stucco"
    albedo = {
        "brick": float(rng.choice([0.26, 0.32, 0.4, 0.52, 0.62])),
        "ashlar": rng.uniform(0.5, 0.78),
        "stucco": rng.uniform(0.35, 0.8),
    }[material]
    shops = chosen == "taxpayer" or rng.random() < (
        0.45 if chosen == "rowhouse" else 0.85
    )
    return FrontStyle(
        seed=int(rng.integers(2**31)),
        kind=chosen,
        width_m=float(width_m),
        storeys=int(rng.integers(least, most + 1)),
        base_m=float(rng.uniform(4.0, 4.8)) if shops else float(rng.uniform(3.6, 4.2)),
        crown_m=float(rng.uniform(0.9, 1.7)),
        material=material,
        albedo=albedo * float(rng.uniform(0.9, 1.1)),
        shops=bool(shops),
        sun=sun,
    )


def rhythm(rng: np.random.Generator, style: FrontStyle) -> tuple[np.ndarray, float]:
    """Give the middles of the bays and the width of a window, in metres."""
    pitch = {
        "rowhouse": rng.uniform(1.9, 2.4),
        "tenement": rng.uniform(1.7, 2.2),
        "loft": rng.uniform(2.6, 4.2),
        "office": rng.uniform(2.0, 3.0),
        "hotel": rng.uniform(2.0, 2.8),
        "taxpayer": rng.uniform(2.4, 3.6),
    }[style.kind]
    count = max(2, round((style.width_m - 0.6) / pitch))
    edges = np.linspace(0.35, style.width_m - 0.35, count + 1)
    bays = (edges[:-1] + edges[1:]) / 2
    fill = 0.78 if style.kind in ("loft", "taxpayer") else rng.uniform(0.46, 0.56)
    return bays, float(fill * (edges[1] - edges[0]))


def window_style(
    rng: np.random.Generator, style: FrontStyle, *, stone: float
) -> WindowStyle:
    """Choose the windows of a front."""
    heads: dict[Kind, tuple[Head, ...]] = {
        "rowhouse": ("hood", "stone", "stone", "segment"),
        "tenement": ("segment", "keystone", "hood", "arch", "stone"),
        "loft": ("flat", "stone"),
        "office": ("flat", "flat", "stone"),
        "hotel": ("stone", "keystone", "flat"),
        "taxpayer": ("flat", "stone"),
    }
    lights = [(1, 1), (2, 1), (2, 2), (3, 2)]
    return WindowStyle(
        head=heads[style.kind][int(rng.integers(len(heads[style.kind])))],
        lights=lights[int(rng.choice(4, p=[0.5, 0.25, 0.15, 0.1]))],
        frame=float(rng.choice([0.18, 0.5, 0.65, 0.75])),
        stone=stone,
        dressed=float(rng.uniform(0.4, 0.85)),
    )
