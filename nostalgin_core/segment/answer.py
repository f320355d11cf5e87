"""What a segmentation network may answer; anything else is refused, not interpreted."""

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple, get_args

import numpy as np
from jaxtyping import Float32

from nostalgin_core.records import Category

CATEGORIES: tuple[Category, ...] = get_args(Category)
STRIDE_PX: Final = 4  # of the network's input, a pixel's answer
PLANES: Final = 4  # ground, front, what hides it, an end of a front
COARSEST_PX: Final = 32  # a cell's that says whether it is in a room
PROBE_PX: Final = 64

Network = Callable[[Float32[np.ndarray, "1 1 h w"]], tuple[np.ndarray, ...]]
"""Maps gray 0 to 255 to boxes (n 4), labels from 1 (n), scores (n), masks (n m m),
pixels (4 h/4 w/4): how likely each is ground, front, what hides it, and a front's end,
and indoors (1 h/32 w/32): logits whose mean tells rooms from streets.
"""

Pixels = Float32[np.ndarray, "4 rows columns"]
Say = Float32[np.ndarray, "1 rows columns"]


class Nonsense(ValueError):  # noqa: N818 - it reads as what it is about
    """An answer that no segmentation network of this program gives."""


class Answer(NamedTuple):
    """Boxes (n 4), labels from 1 (n), scores (n), masks (n m m), pixels, indoors."""

    boxes: np.ndarray
    labels: np.ndarray
    scores: np.ndarray
    masks: np.ndarray
    pixels: Pixels
    indoors: Say


def checked(answer: Sequence[np.ndarray], shape: tuple[int, int]) -> Answer:
    """Take a network's answer about an image of so many rows and columns.

    Raises:
        Nonsense: if it is none.
    """
    if len(answer) != len(Answer._fields):
        raise Nonsense(
            f"the segmentation network gives {len(answer)} outputs instead of boxes, "
            "labels, scores, masks, pixels and indoors: it is older than this program; "
            "install the package again, or export it anew"
        )
    told = Answer(*answer)
    count, size = len(told.labels), told.masks.shape[-1] if told.masks.ndim else 0
    shapes = (
        (count, 4),
        (count,),
        (count,),
        (count, size, size),
        (PLANES, *(side // STRIDE_PX for side in shape)),
        (1, *(side // COARSEST_PX for side in shape)),
    )
    for name, one, wanted in zip(Answer._fields, answer, shapes, strict=True):
        if one.shape != wanted:
            raise Nonsense(f"{name} have shape {one.shape}, not {wanted}")
        if not np.isfinite(one).all():
            raise Nonsense(f"{name} are no numbers")
    if not np.isin(told.labels, np.arange(1, len(CATEGORIES) + 1)).all():
        raise Nonsense(f"labels are other than 1 to {len(CATEGORIES)}")
    return told


def probe(network: Network) -> None:
    """Ask a network about a small blank image, before it is asked about photographs.

    Raises:
        Nonsense: if it answers any.
    """
    blank = np.zeros((1, 1, PROBE_PX, PROBE_PX), np.float32)
    checked(network(blank), (PROBE_PX, PROBE_PX))
