"""One building front, painted as an architect would draw it and the sun would light it.

A front is drawn from its style (`style`): storeys, windows, cornice, ground floor. The
drawing is an albedo and a relief (`relief.Board`); its lit picture is the texture.
"""

import numpy as np

from nostalgin_core.arrays import Gray
from nostalgin_core.scenes import shop, trim, wall
from nostalgin_core.scenes.relief import Board, blank, box, cut, light
from nostalgin_core.scenes.style import STOREY_M, FrontStyle, rhythm, window_style
from nostalgin_core.scenes.window import WindowStyle, paint_window


def paint(style: FrontStyle, *, px_per_m: float = 40.0) -> Gray:
    """Paint a front's texture: 40 pixels a metre is what a tax photo resolves."""
    look = np.random.default_rng([style.seed, 0])
    rng = np.random.default_rng([style.seed, 1 + style.wing])
    board = draw(look, rng, style, px_per_m=px_per_m)
    lit = light(board, style.sun, ambient=0.36 if style.sun[2] > 0.05 else 0.47)
    worn = wall.weather(rng, lit, px_per_m=px_per_m)
    return np.round(255 * (0.05 + 0.95 * worn**0.62)).astype(np.uint8)


def draw(
    look: np.random.Generator,
    rng: np.random.Generator,
    style: FrontStyle,
    *,
    px_per_m: float,
) -> Board:
    """Draw a front, not yet lit.

    `look` decides what all fronts of one building share, `rng` everything else.
    """
    board = blank(style.width_m, style.height_m, px_per_m=px_per_m)
    wall.clad(rng, board, material=style.material, albedo=style.albedo)
    pale = float(look.uniform(0.45, 0.7))
    stone = pale if look.random() < 0.7 else style.albedo * 0.9
    bays, wide = rhythm(look, style)
    windows = window_style(look, style, stone=stone)
    storeys(look, rng, board, style, bays=bays, wide=wide, windows=windows)
    ground(rng, board, style, bays=bays, wide=wide, windows=windows)
    crown(look, board, style, stone=stone)
    seam(board, style)
    return board


def seam(board: Board, style: FrontStyle) -> None:
    """Leave a dark joint to the neighbours, where rain has run for years."""
    top = style.height_m - style.crown_m
    for left in (0.0, style.width_m - 0.05):
        where = cut(board, left, 0.0, left + 0.05, top)
        board.albedo[where] *= 0.6


def storeys(
    look: np.random.Generator,
    rng: np.random.Generator,
    board: Board,
    style: FrontStyle,
    *,
    bays: np.ndarray,
    wide: float,
    windows: WindowStyle,
) -> None:
    """Set the windows of all upper storeys, and what divides them."""
    each = STOREY_M[style.kind]
    stone = windows.stone
    top = WindowStyle("arch", windows.lights, windows.frame, stone, windows.dressed)
    pitch = float(bays[1] - bays[0])
    if style.kind in ("loft", "office") and look.random() < 0.6:
        edges = np.append(bays - pitch / 2, bays[-1] + pitch / 2)
        high = style.height_m - style.crown_m
        trim.pilasters(
            board, edges=edges, low_m=style.base_m, high_m=high, albedo=stone
        )
    arched = look.random() < 0.18 and wide < 1.6
    low = look.uniform(0.75, 0.95)
    tall = min(each - low - 0.55, 2.25)
    parts = max(1, round(wide / 1.25))
    floors = style.base_m + each * np.arange(style.storeys - 1)
    for storey, floor in enumerate(floors):
        last = storey == len(floors) - 1
        drop = wide / 2 if last and arched else 0.0
        for x in bays:
            part = wide / parts
            for k in range(parts):
                left = x - wide / 2 + k * part
                place = (left, floor + low, left + part - 0.06 * (parts > 1))
                paint_window(
                    rng,
                    board,
                    (*place, floor + low + tall - drop),
                    style=top if drop else windows,
                )
    dressing(look, rng, board, style, floors=floors, bays=bays, stone=stone)


def dressing(
    look: np.random.Generator,
    rng: np.random.Generator,
    board: Board,
    style: FrontStyle,
    *,
    floors: np.ndarray,
    bays: np.ndarray,
    stone: float,
) -> None:
    """Add belts, quoins, fire escapes and a wall sign, as suits the house."""
    if len(floors) and look.random() < 0.5:
        trim.belt(
            board, width_m=style.width_m, at_m=float(floors[0]) + 0.1, albedo=stone
        )
    if len(floors) > 2 and look.random() < 0.35:
        trim.belt(
            board, width_m=style.width_m, at_m=float(floors[-1]) + 0.1, albedo=stone
        )
    high = style.height_m - style.crown_m
    if len(floors) > 1 and look.random() < 0.3:
        trim.bands(board, style.width_m, floors=floors, albedo=stone)
    if len(floors) > 1 and look.random() < 0.4:
        trim.panels(look, board, bays=bays, floors=floors, albedo=stone)
    if style.kind in ("rowhouse", "hotel") and look.random() < 0.3:
        trim.quoins(
            board, width_m=style.width_m, low_m=style.base_m, high_m=high, albedo=stone
        )
    if len(floors) and style.shops and rng.random() < 0.3:
        low = float(floors[0]) + 0.16
        trim.wall_sign(rng, board, width_m=style.width_m, low_m=low, high_m=low + 0.6)
    iron = style.kind == "tenement" or (style.kind == "loft" and rng.random() < 0.4)
    if iron and len(floors) > 1 and rng.random() < 0.8:
        pitch = float(bays[1] - bays[0])
        first = int(rng.integers(0, max(1, len(bays) - 1)))
        last = min(first + 1, len(bays) - 1)
        trim.fire_escape(
            rng,
            board,
            left_m=float(bays[first]) - 0.45 * pitch,
            right_m=float(bays[last]) + 0.45 * pitch,
            floors_m=floors + 0.35,
        )


def ground(
    rng: np.random.Generator,
    board: Board,
    style: FrontStyle,
    *,
    bays: np.ndarray,
    wide: float,
    windows: WindowStyle,
) -> None:
    """Paint the ground floor: shops, arches, or a door with a stoop."""
    if style.shops:
        if style.kind in ("office", "loft") and rng.random() < 0.25:
            base = (0.0, 0.0, style.width_m, style.base_m)
            box(board, base, albedo=windows.stone, relief_m=0.04)
            shop.arcade(rng, board, bays=bays, high_m=style.base_m)
        else:
            shop.shopfronts(rng, board, width_m=style.width_m, high_m=style.base_m)
        return
    shop.parlour(
        rng,
        board,
        bays=bays,
        wide_m=min(wide, 1.6),
        high_m=style.base_m,
        style=windows,
    )


def crown(
    look: np.random.Generator, board: Board, style: FrontStyle, *, stone: float
) -> None:
    """End the front at the sky."""
    top = style.height_m
    if style.kind in ("taxpayer", "office") or look.random() < 0.25:
        trim.parapet(board, width_m=style.width_m, top_m=top, albedo=stone)
        return
    metal = float(look.choice([0.12, 0.25, 0.4, stone]))
    trim.cornice(
        look,
        board,
        width_m=style.width_m,
        top_m=top,
        high_m=style.crown_m,
        albedo=metal,
    )
