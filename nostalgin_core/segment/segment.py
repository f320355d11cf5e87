"""The network's few boxes and small masks become things in a photo.

The photo's exposed frame is resized so that its short side is what the network was
trained on, each side a multiple of the network's coarsest stride. A detection brings a
coarse mask of probabilities over its box; it is laid over the box bilinearly, with the
outer half of its border texels cut off, as Mask R-CNN's masks are defined (He et al.
2017, section 3). With it comes what every pixel is (`pixels`), which mends the masks.
"""

from typing import NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, Float32, Int

from nostalgin_core.arrays import Gray, Probability
from nostalgin_core.records import Box, Instance, Photo, Rejection
from nostalgin_core.segment.answer import (
    CATEGORIES,
    Answer,
    Network,
    Pixels,
    checked,
)
from nostalgin_core.segment.flare import flares
from nostalgin_core.segment.hiding import hiding
from nostalgin_core.segment.indoors import REASON, REMEDY, inside, log_odds
from nostalgin_core.segment.pixels import mended
from nostalgin_core.segment.posture import doubted, excess, sure, undone
from nostalgin_core.segment.punch import healed, punches
from nostalgin_core.segment.roofs import without_walls_behind
from nostalgin_core.segment.sheet import of_frame, within
from nostalgin_core.segment.sky import without_sky
from nostalgin_core.segment.walls import without_walls

STRIDE_PX = 32


class Found(NamedTuple):
    """What the network makes of a photo."""

    things: tuple[Instance, ...]  # surest first
    pixels: Pixels  # of the frame
    sure: float  # share of the pixels that it was shown and is sure of
    indoors: float  # log odds that it was taken in a room


def segment(
    photo: Photo,
    network: Network,
    *,
    short_px: int = 416,
    long_px: int = 1344,
    facade_score: float = 0.45,
    occluder_score: float = 0.2,
) -> tuple[Instance, ...] | Rejection:
    """Find fronts and what hides them, surest first.

    416 px did best on the held-out block: larger, and towers outgrow what the network
    takes in at a glance. `long_px` bounds memory on panoramas. Scores below the two
    thresholds are dropped: between 0.4 and 0.5 for fronts little changes, and below 0.2
    the exported network is silent.

    Raises:
        Nonsense: if the network doesn't answer what `Network` says.
    """
    least = min(facade_score, occluder_score)
    found = everything(photo, network, least=least, short_px=short_px, long_px=long_px)
    other = fallen(photo, found, network, short_px=short_px, long_px=long_px)
    if other is not None:
        return other
    if inside(found.indoors, found.things):
        return Rejection(photo.key, "segment", REASON, REMEDY)
    return trusted(
        photo, found, facade_score=facade_score, occluder_score=occluder_score
    )


def everything(
    photo: Photo,
    network: Network,
    *,
    least: float,
    short_px: int = 416,
    long_px: int = 1344,
) -> Found:
    """Place all that the network gives a score of `least`, surest first.

    It is shown the photo with punched holes healed, and a print on its paper.

    Raises:
        Nonsense: if the network doesn't answer what `Network` says.
    """
    sheet = photo.sheet or photo.frame
    x0, y0, x1, y1 = sheet
    gray = shown(photo, short_px=short_px, long_px=long_px)
    boxes, labels, scores, masks, pixels, indoors = asked(gray, network)
    scale = np.array([x1 - x0, y1 - y0] * 2) / (gray.shape[::-1] * 2)
    found = []
    for i in np.argsort(-scores, kind="stable"):
        if scores[i] < least:
            break
        placed = laid_over(masks[i], boxes[i] * scale, (y1 - y0, x1 - x0))
        if placed is not None:
            box, probability = placed
            here = Box(box.x0 + x0, box.y0 + y0, box.x1 + x0, box.y1 + y0)
            category = CATEGORIES[int(labels[i]) - 1]
            found.append(Instance(category, float(scores[i]), here, probability))
    told, room = sure(pixels), log_odds(indoors, sheet, photo.frame)
    if photo.sheet is None:
        return Found(tuple(found), pixels, told, room)
    pictured = tuple(within(found, photo.frame))
    return Found(pictured, of_frame(pixels, sheet, photo.frame), told, room)


def shown(
    photo: Photo, *, short_px: int = 416, long_px: int = 1344
) -> Float32[np.ndarray, "rows columns"]:
    """Return what the network is shown: punched holes healed, a print on its paper."""
    x0, y0, x1, y1 = photo.sheet or photo.frame
    whole = healed(photo, punches(photo))[y0:y1, x0:x1]
    return prepared(whole, short_px=short_px, long_px=long_px)


def asked(gray: Float32[np.ndarray, "rows columns"], network: Network) -> Answer:
    """Ask about a picture at the network's scale.

    Raises:
        Nonsense: if the network doesn't answer what `Network` says.
    """
    return checked(network(gray[None, None]), gray.shape)


def fallen(
    photo: Photo,
    found: Found,
    network: Network,
    *,
    short_px: int = 416,
    long_px: int = 1344,
) -> Rejection | None:
    """Refuse a photo that is turned or a negative; None where it stands upright.

    Of two postures that are believed, the network is surer of the right one.

    Raises:
        Nonsense: if the network doesn't answer what `Network` says.
    """
    x0, y0, x1, y1 = photo.sheet or photo.frame
    frame = photo.image[y0:y1, x0:x1]
    here, most, lying = found.sure, 0.0, None
    for doubt in doubted(frame):
        undoing = undone(frame, doubt.posture)
        gray = prepared(undoing, short_px=short_px, long_px=long_px)
        there = sure(asked(gray, network).pixels)
        if excess(doubt, there, here) > 0 and there > most:
            most, lying = there, doubt.posture
    if lying is None:
        return None
    return Rejection(
        photo.key,
        "segment",
        lying.reason,
        "the network is surer of the street that it sees otherwise: "
        f"{lying.remedy}, and index the folder again",
    )


def trusted(
    photo: Photo,
    found: Found,
    *,
    facade_score: float = 0.45,
    occluder_score: float = 0.2,
    roofed: bool = True,
) -> tuple[Instance, ...] | Rejection:
    """Keep what scores enough for its kind; a photo without a front is refused.

    A tax photo has one number board, so of the placards only the surest is kept. What
    is painted on fronts is dropped (`hiding`), pixels mend the masks of the rest, and
    fronts that prove to be bare walls go (`walls`), and so does sky on the others
    (`sky`); punched holes and flares on fronts are added, for the network was taught
    few or none. Last, fronts are cut off at their roofs (`roofs`), unless they are to
    be left unroofed.
    """
    least = {"facade": facade_score}
    board = max((f.score for f in found.things if f.category == "placard"), default=0.0)
    kept = tuple(
        one
        for one in found.things
        if one.score >= least.get(one.category, occluder_score)
        and (one.category != "placard" or one.score == board)
    )
    if any(one.category == "facade" for one in kept):
        agreed = mended(hiding(kept), found.pixels, photo.frame)
        judged = without_walls(photo, agreed, found.pixels)
        if not any(one.category == "facade" for one in judged):
            return Rejection(
                photo.key,
                "segment",
                "walls alone",
                "what looks like fronts shows neither windows nor cornices: mask it by "
                "hand if there is one",
            )
        left = punches(photo) + flares(photo, kept) + without_sky(photo, judged)
        return without_walls_behind(photo, left, found.pixels) if roofed else left
    return Rejection(
        photo.key,
        "segment",
        "no facade found",
        f"no front scored {facade_score} or more; photograph shows none, or is too "
        "dark or too small to tell: mask it by hand, or lower facade_score",
    )


def prepared(
    frame: Gray, *, short_px: int, long_px: int
) -> Float32[np.ndarray, "rows columns"]:
    """Resize to the network's scale, each side to the nearest multiple of 32."""
    height, width = frame.shape
    scale = min(short_px / min(height, width), long_px / max(height, width))
    rows, columns = (
        max(STRIDE_PX, round(side * scale / STRIDE_PX) * STRIDE_PX)
        for side in (height, width)
    )
    shrunk = rows * columns < height * width
    how = cv2.INTER_AREA if shrunk else cv2.INTER_LINEAR
    return cv2.resize(frame, (columns, rows), interpolation=how).astype(np.float32)


def laid_over(
    mask: Float[np.ndarray, "m m"],
    box: Float[np.ndarray, " 4"],
    shape: tuple[int, int],
) -> tuple[Box, Probability] | None:
    """Stretch a mask over its box; None where the box holds no whole pixel.

    Texel j of m lies at x0 + (j + 1/2) (x1 - x0) / m - 1/2 on the photo's pixel grid.
    """
    height, width = shape
    x0, y0 = np.maximum(np.floor(box[:2]), 0).astype(int)
    x1, y1 = np.minimum(np.ceil(box[2:]), (width, height)).astype(int)
    if x1 <= x0 or y1 <= y0:
        return None
    texels = mask.shape[0]
    us = _texel_of(np.arange(x0, x1), box[0], box[2], texels)
    vs = _texel_of(np.arange(y0, y1), box[1], box[3], texels)
    across = _interpolation(us, texels)
    down = _interpolation(vs, texels)
    probability = down @ mask.astype(np.float32) @ across.T
    return Box(int(x0), int(y0), int(x1), int(y1)), np.clip(probability, 0, 1)


def _texel_of(
    pixels: Int[np.ndarray, " n"], low: float, high: float, texels: int
) -> Float[np.ndarray, " n"]:
    """Return where pixel centres fall among texels, held inside the mask."""
    size = max(high - low, 1.0)
    return np.clip((pixels + 0.5 - low) / size * texels - 0.5, 0, texels - 1)


def _interpolation(
    places: Float[np.ndarray, " n"], texels: int
) -> Float32[np.ndarray, "n m"]:
    """Return the weights that interpolate linearly at the given places."""
    distance = np.abs(places[:, None] - np.arange(texels)[None])
    return np.maximum(0, 1 - distance).astype(np.float32)
