"""A print is shown to the network with its paper, and answers are kept of its picture.

The network was taught on prints as they were scanned, paper and all; a picture that is
cut out of its paper is strange to it. But nothing on the paper is part of a street.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import cv2
import numpy as np
from jaxtyping import Float32

from nostalgin_core.records import Box, Instance
from nostalgin_core.segment.answer import Pixels


def within(things: Sequence[Instance], frame: Box) -> Iterator[Instance]:
    """Yield what of things lies in the frame."""
    for one in things:
        x0, y0 = max(one.box.x0, frame.x0), max(one.box.y0, frame.y0)
        x1, y1 = min(one.box.x1, frame.x1), min(one.box.y1, frame.y1)
        if x0 < x1 and y0 < y1:
            here = np.s_[
                y0 - one.box.y0 : y1 - one.box.y0, x0 - one.box.x0 : x1 - one.box.x0
            ]
            kept = np.ascontiguousarray(one.probability[here])
            yield replace(one, box=Box(x0, y0, x1, y1), probability=kept)


def of_frame(
    pixels: Pixels, sheet: Box, frame: Box
) -> Float32[np.ndarray, "4 high wide"]:
    """Cut what is said of a sheet's pixels down to the frame, as finely."""
    _, rows, columns = pixels.shape
    fx = columns / (sheet.x1 - sheet.x0)
    fy = rows / (sheet.y1 - sheet.y0)
    wide, high = (frame.x1 - frame.x0) * fx, (frame.y1 - frame.y0) * fy
    size = max(1, round(wide)), max(1, round(high))
    step = wide / size[0], high / size[1]
    sheet_from_frame = np.array(
        [
            [step[0], 0, (frame.x0 - sheet.x0) * fx + step[0] / 2 - 0.5],
            [0, step[1], (frame.y0 - sheet.y0) * fy + step[1] / 2 - 0.5],
        ]
    )
    how = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    planes = [
        cv2.warpAffine(
            plane, sheet_from_frame, size, flags=how, borderMode=cv2.BORDER_REPLICATE
        )
        for plane in pixels
    ]
    return np.stack(planes).astype(pixels.dtype)
