"""The paper's figure of one photo on its way through the stages, as one picture."""

import cv2
import numpy as np

from nostalgin_core.arrays import Corners, Lines
from nostalgin_core.records import Elevation, Matted, Photo
from nostalgin_core.steps import Stages
from pipelines.explain import draw
from pipelines.explain.draw import Colour

HEIGHT_PX = 520  # of one tile: a tax photograph keeps its windows
CAPTION_PX = 26
GAP_PX = 8
WIDTH_PX = 2400  # of a row
WHITE = 255

Tile = tuple[str, Colour]


def panel(made: Stages, lines: Lines) -> Colour:
    """Set the stages side by side: as many tiles as the photo got to.

    Input | facades | occluders | matte facades | matte occluders | lines by vanishing
    point | each elevation rectified, then inpainted (figure `complete` of the paper).
    """
    if made.photo is None:
        return np.full((HEIGHT_PX + CAPTION_PX, HEIGHT_PX, 3), WHITE, np.uint8)
    tiles: list[Tile] = [("input", draw.in_colour(made.photo.image))]
    if made.matted is not None:
        tiles += segmented(made.photo, made.matted, made.rectified)
        tiles += cut_outs(made.photo, made.matted)
    if made.rectified:
        tiles.append(("lines", line_picture(made.photo, made.rectified, lines)))
    tiles += finals(made.rectified, made.elevations)
    return rows([captioned(*tile) for tile in tiles])


def segmented(
    photo: Photo, matted: Matted, rectified: tuple[Elevation, ...]
) -> list[Tile]:
    """Draw what the network saw: facades with their quads, and occluders."""
    facades = occluders = draw.in_colour(photo.image)
    width = max(2, photo.image.shape[0] // 300)
    for one in matted.facades:
        facades = draw.tinted(facades, one.mask, draw.facade_colour(one.index))
    for view in rectified:
        colour = draw.facade_colour(view.facade)
        facades = draw.outlined(facades, view.quad, colour, width_px=width)
    for hidden in matted.occluders:
        occluders = draw.tinted(occluders, hidden.mask, draw.OCCLUDER)
    return [("segment: facades", facades), ("segment: occluders", occluders)]


def cut_outs(photo: Photo, matted: Matted) -> list[Tile]:
    """Draw what matting left of the facades, and of what hides them."""
    nothing = np.zeros(photo.image.shape)
    facades = np.max([nothing, *(one.alpha for one in matted.facades)], axis=0)
    hidden = np.max([nothing, *(one.mask for one in matted.occluders)], axis=0)
    return [
        ("matte: facades", draw.cut_out(photo.image, facades)),
        ("matte: occluders", draw.cut_out(photo.image, hidden)),
    ]


def line_picture(
    photo: Photo, rectified: tuple[Elevation, ...], lines: Lines
) -> Colour:
    """Draw each line in the colour of the vanishing point that it runs to.

    Each facade's horizontal point has the facade's colour, the vertical point is dark,
    and what runs to neither, or lies on no facade, is pale.
    """
    picture = draw.in_colour((photo.image // 3 + 170).astype(np.uint8))
    picture = draw.stroked(picture, lines, draw.NEITHER)
    for view in rectified:
        on = lines[on_quad(lines, view.quad)]
        across, up = view.vanishing_points[:2]
        upright = draw.fits(on, up)
        picture = draw.stroked(picture, on[upright], draw.VERTICAL)
        level = draw.fits(on, across) & ~upright
        picture = draw.stroked(picture, on[level], draw.facade_colour(view.facade))
    return picture


def on_quad(lines: Lines, quad: Corners) -> np.ndarray:
    """Tell which lines have their middle inside a quadrangle."""
    outline = quad.astype(np.float32)
    middles = (lines[:, :2] + lines[:, 2:]) / 2
    return np.array(
        [cv2.pointPolygonTest(outline, (x, y), False) >= 0 for x, y in middles],  # noqa: FBT003
        dtype=bool,
    )


def finals(
    rectified: tuple[Elevation, ...], elevations: tuple[Elevation, ...]
) -> list[Tile]:
    """Pair each facade as it was rectified with what the inpainter made of it."""
    done = {one.facade: one for one in elevations}
    tiles: list[Tile] = []
    for view in rectified:
        tiles.append((f"rectify {view.facade}", draw.in_colour(view.image)))
        if view.facade in done:
            image = done[view.facade].image
            tiles.append((f"inpaint {view.facade}", draw.in_colour(image)))
    return tiles


def captioned(caption: str, picture: Colour) -> Colour:
    """Scale a picture to the panel's height and write its caption below it."""
    scale = HEIGHT_PX / picture.shape[0]
    width = int(np.clip(round(picture.shape[1] * scale), 60, 3 * HEIGHT_PX))
    method = cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR
    small = cv2.resize(picture, (width, HEIGHT_PX), interpolation=method)
    foot = np.full((CAPTION_PX, width, 3), WHITE, np.uint8)
    font = cv2.FONT_HERSHEY_SIMPLEX
    cv2.putText(foot, caption, (2, 18), font, 0.45, (0, 0, 0), 1, cv2.LINE_AA)
    return np.vstack([small, foot])


def rows(tiles: list[Colour]) -> Colour:
    """Set tiles in rows, each as wide as the panel allows."""
    lines: list[list[Colour]] = [[]]
    for tile in tiles:
        width = sum(one.shape[1] + GAP_PX for one in lines[-1])
        if lines[-1] and width + tile.shape[1] > WIDTH_PX:
            lines.append([])
        lines[-1].append(tile)
    strips = [beside(line) for line in lines]
    widest = max(strip.shape[1] for strip in strips)
    return np.vstack([widened(strip, widest) for strip in strips])


def widened(strip: Colour, width: int) -> Colour:
    """Add white on the right."""
    missing = width - strip.shape[1]
    return np.pad(strip, ((0, 0), (0, missing), (0, 0)), constant_values=WHITE)


def beside(tiles: list[Colour]) -> Colour:
    """Set tiles of one height side by side with a gap between them."""
    gap = np.full((tiles[0].shape[0], GAP_PX, 3), WHITE, np.uint8)
    row = [part for tile in tiles for part in (tile, gap)]
    return np.hstack(row[:-1])
