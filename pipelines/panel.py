"""The paper's figure of one photo on its way through the stages, as one picture."""

import cv2
import numpy as np

from nostalgin_core.arrays import Lines
from nostalgin_core.reconstruct import Reconstruction
from nostalgin_core.records import Elevation, Matted, Photo
from pipelines import draw
from pipelines.draw import Colour

HEIGHT_PX = 520  # of one tile: a tax photograph keeps its windows
CAPTION_PX = 26
GAP_PX = 8
WHITE = 255

Tile = tuple[str, Colour]


def panel(made: Reconstruction, lines: Lines) -> Colour:
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
    return beside([captioned(*tile) for tile in tiles])


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
    """Draw the lines, coloured by the vanishing points of the widest facade."""
    widest = max(rectified, key=lambda one: one.image.size)
    pale = draw.in_colour((photo.image // 2 + 127).astype(np.uint8))
    return draw.with_lines(pale, lines, widest.vanishing_points)


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


def beside(tiles: list[Colour]) -> Colour:
    """Set tiles of one height side by side with a gap between them."""
    gap = np.full((tiles[0].shape[0], GAP_PX, 3), WHITE, np.uint8)
    row = [part for tile in tiles for part in (tile, gap)]
    return np.hstack(row[:-1])
