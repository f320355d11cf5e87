"""Words as sign writers painted them, fitted to a box."""

import cv2
import numpy as np

from nostalgin_core.scenes.relief import Board, cut

TRADES = (
    "RESTAURANT",
    "CAFETERIA",
    "HARDWARE",
    "TAILOR",
    "DRUGS",
    "BARBER",
    "SHOE REPAIR",
    "CIGARS",
    "FURS",
    "LAUNDRY",
    "BAKERY",
    "RADIO",
    "MILLINERY",
    "PRINTING",
    "LUNCHEONETTE",
    "BAR & GRILL",
    "DELICATESSEN",
    "FLORIST",
    "TRUNKS",
    "PAINTS",
    "BEAUTY SHOP",
    "STATIONERY",
    "HATS",
    "OPTICIAN",
)
NAMES = (
    "ADLER",
    "MORAN'S",
    "KLEIN BROS",
    "ROSSI",
    "PETERSEN",
    "DUNN & CO",
    "LEVY'S",
    "STAR",
    "EMPIRE",
    "CROWN",
    "BELMONT",
    "REGAL",
    "OLYMPIA",
    "HARBOR",
    "FERRY",
    "ECLIPSE",
)
NOTICES = ("LOFTS TO LET", "HOTEL", "ROOMS", "OFFICES", "STORAGE", "FACTORY SPACE")


def legend(rng: np.random.Generator) -> str:
    """Make up what a shop is called."""
    trade = str(rng.choice(TRADES))
    return f"{rng.choice(NAMES)} {trade}" if rng.random() < 0.5 else trade


def write(
    board: Board,
    place: tuple[float, float, float, float],
    text: str,
    *,
    albedo: float,
    font: int = cv2.FONT_HERSHEY_DUPLEX,
    relief_m: float | None = None,
) -> None:
    """Write text as large as a box (left, low, right, high) allows, centred.

    Text that would come out less than five pixels high is left out.
    """
    where = cut(board, *place)
    plane = board.albedo[where]
    h, w = plane.shape
    if h < 5 or w < 8:
        return
    (long, tall), _ = cv2.getTextSize(text, font, 1.0, 1)
    scale = min(0.82 * h / tall, 0.92 * w / long)
    if tall * scale < 5:
        return
    ink = lettered(text, (h, w), font=font, scale=scale)
    plane[:] = plane * (1 - ink) + albedo * ink
    if relief_m is not None:
        deep = board.relief_m[where]
        deep[:] = np.maximum(deep, relief_m * ink)


def lettered(
    text: str,
    shape: tuple[int, int],
    *,
    font: int,
    scale: float,
    bold_px: float = 2.2,
) -> np.ndarray:
    """Give the ink of one line of text, 0 to 1, centred on a sheet of this shape."""
    bold = max(1, round(bold_px * scale))
    (long, tall), _ = cv2.getTextSize(text, font, scale, bold)
    at = (round((shape[1] - long) / 2), round((shape[0] + tall) / 2))
    sheet = np.zeros(shape, np.uint8)
    cv2.putText(sheet, text, at, font, scale, 255, bold, cv2.LINE_AA)
    return sheet.astype(np.float32) / 255
