"""A room is no street, though its walls and doors look like fronts.

Each cell of the network's coarsest grid has its say whether the photograph was taken
indoors (`Answer.indoors`, logits); what counts is their mean, over the picture alone
where it lies on paper. The head was fitted to photographs of modern rooms and to
streets old and new (`export/fit_indoors.py`). A number board stands on a street, even
under a roof, so that a photograph in which one is found is no room.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np
from jaxtyping import Float

from nostalgin_core.records import Box, Instance
from nostalgin_core.segment.answer import Say

ENOUGH: Final = -0.9  # one street in 2,000 is expected above it
BOARD: Final = 0.5  # score of a board that is believed
REASON: Final = "likely an interior"
REMEDY: Final = (
    "it looks more like a room than like a street, as a bridge or a view from the air "
    "may: leave it out, or draw the outline of its front if it shows one"
)


def inside(log_odds: float, things: Sequence[Instance]) -> bool:
    """Tell whether a photograph was taken indoors, by its log odds and its board."""
    boards = (one.score for one in things if one.category == "placard")
    return log_odds > ENOUGH and max(boards, default=0.0) < BOARD


def log_odds(say: Say, sheet: Box, frame: Box) -> float:
    """Return the log odds that a photograph was taken indoors.

    Args:
        say: What the network's cells say of the sheet.
        sheet: What the network was shown.
        frame: The picture on it.
    """
    down, across = shares(say.shape[1:], sheet, frame)
    return float(down @ say[0].astype(np.float64) @ across)


def shares(
    cells: tuple[int, ...], sheet: Box, frame: Box
) -> tuple[Float[np.ndarray, " rows"], Float[np.ndarray, " columns"]]:
    """Return how much of the frame each row and column of a grid on the sheet has."""
    rows, columns = cells
    high, wide = sheet.y1 - sheet.y0, sheet.x1 - sheet.x0
    return (
        _shares(rows, (frame.y0 - sheet.y0) / high, (frame.y1 - sheet.y0) / high),
        _shares(columns, (frame.x0 - sheet.x0) / wide, (frame.x1 - sheet.x0) / wide),
    )


def _shares(cells: int, low: float, high: float) -> Float[np.ndarray, " n"]:
    ends = np.clip(np.arange(cells + 1) / cells, low, high)
    return np.diff(ends) / (high - low)
