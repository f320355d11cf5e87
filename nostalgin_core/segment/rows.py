"""What each row of a front, laid straight, tells of whether the front ends there.

Along a roof an edge runs across the whole front. Below it windows stand in rows and
columns; above it there is less to see, or what there is stands in other columns. Rows
grow downwards; what nothing hides is counted alone.
"""

from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Bool, Float, Float32, Int

GRAIN_PX: Final = 0.7
EDGE: Final = (
    0.025  # a texel's change from which it is an edge; 1 is white beside black
)
CAP: Final = 0.06
APART_PX: Final = 2  # rows beside a roof that are neither above nor below it
STRIP_PX: Final = 5  # rows on either side whose tones are compared
NEAR_PX: Final = 3  # standard deviation of what counts as round a texel
FLAT: Final = 0.02  # standard deviation of tones round a texel, below which it is blank
BAND: Final = 0.08  # of a patch's height: a row of windows
SHARES: Final = (0.04, 0.85)  # of a front that may lie above its roof
MOST_DENSE: Final = 0.6  # of upright edges: more says no more
FEW: Final = 3  # texels of a column, or its edges say nothing
SEEN: Final = 0.3  # of a row that nothing may hide

NAMES: Final = (
    *("1", "edge", "gap", "any edge", "end", "step"),
    *("upright edges above", "most above", "below", "columns alike"),
    *("tones apart", "front above", "front below", "ground above"),
    *("flat above", "flat below", "rows above", "rows below"),
    *("share above", "height", "score", "wider above", "tone above"),
)
_Plane = Float32[np.ndarray, "h w"]
_Rows = Float[np.ndarray, " h"]


class Planes(NamedTuple):
    """What is seen of a front, laid straight or not."""

    tone: _Plane
    visible: _Plane  # the front, but for what hides it
    whole: _Plane
    end: _Plane  # as the semantic branch has it, and the next two
    front: _Plane
    ground: _Plane


def features(
    shown: Planes, score: float
) -> tuple[Float[np.ndarray, "h 23"], Bool[np.ndarray, " h"]]:
    """Return what is weighed of each row (`NAMES`), and which rows may be a roof.

    Args:
        shown: A front, laid straight.
        score: The network's.
    """
    height, width = shown.tone.shape
    ring = np.ones((5, 3), np.uint8)
    clear = cv2.erode(shown.visible, ring, borderType=cv2.BORDER_REPLICATE) > 0.5
    smooth = cv2.GaussianBlur(shown.tone, (0, 0), GRAIN_PX)
    across, down = (
        cv2.Sobel(smooth, cv2.CV_32F, dx, dy, ksize=1, scale=0.5)
        for dx, dy in ((1, 0), (0, 1))
    )
    here = clear.astype(np.float32)
    whole = (shown.whole > 0.5).sum(1)
    share = np.cumsum(whole) / max(1, whole.sum())
    one = np.ones(height)
    told = [
        one,
        *_along(shown, down, here),
        *_windows(across, here),
        *_both(shown, smooth, here),
        *_rows(down, here),
        share,
        np.log(height / width) * one,
        score * one,
        _wider(whole),
        _either_side(shown.tone, here)[0],
    ]
    open_to = (share > SHARES[0]) & (share < SHARES[1]) & (whole > 4)
    open_to &= here.sum(1) > SEEN * whole
    return np.column_stack(told), open_to


def _along(shown: Planes, down: _Plane, here: _Plane) -> list[_Rows]:
    """Follow the edge at each row: how much of it, its longest gap, its step."""
    near = np.ones((3, 1), np.uint8)
    lighter, darker = (
        cv2.dilate((change > EDGE).astype(np.float32), near) * here
        for change in (down, -down)
    )
    count = here.sum(1) + 1e-6
    most = np.where((lighter.sum(1) >= darker.sum(1))[:, None], lighter, darker)
    cover = most.sum(1) / count
    gap = _longest_gap(most > 0, here) / np.maximum(count, 1)
    every = np.maximum(lighter, darker).sum(1) / count
    end = (cv2.dilate(shown.end, near) * here).sum(1) / count
    return [cover, gap, every, end, _step(shown.tone, here)]


def _longest_gap(on: np.ndarray, here: _Plane) -> _Rows:
    """Count, row by row, the most texels in a run that no edge interrupts."""
    run = best = np.zeros(len(on), np.float32)
    for x in range(on.shape[1]):
        run = np.where(on[:, x], 0, run + here[:, x])
        best = np.maximum(best, run)
    return best


def _step(tone: _Plane, here: _Plane) -> _Rows:
    """Compare the tones on either side of a row: their step over its deviation."""
    rows = np.arange(len(tone))
    last = len(tone)
    upper = np.clip(rows - 1 - STRIP_PX, 0, last), np.clip(rows - 1, 0, last)
    lower = np.clip(rows + 2, 0, last), np.clip(rows + 2 + STRIP_PX, 0, last)
    total, count = _sums(tone * here), _sums(here)
    means, counts = [], []
    for start, stop in (upper, lower):
        counts.append(count[stop] - count[start])
        means.append((total[stop] - total[start]) / np.maximum(counts[-1], 1e-3))
    both = (counts[0] > 2) & (counts[1] > 2)
    n = both.sum(1) + 1e-6
    change = (means[1] - means[0]) * both
    mean = change.sum(1) / n
    spread = np.sqrt(np.maximum((change**2).sum(1) / n - mean**2, 0) + 1e-4)
    return np.minimum(np.abs(mean) / spread, 3)


def _windows(across: _Plane, here: _Plane) -> list[_Rows]:
    """Count upright edges above, where they are densest, and below; compare columns."""
    edge = (np.abs(across) > EDGE).astype(np.float32)
    height, width = here.shape
    above, below = _either_side(edge, here)
    band = max(3, round(BAND * height))
    cell = (max(3, width // 3), band)
    seen = cv2.blur(here, cell, borderType=cv2.BORDER_CONSTANT)
    dense = cv2.blur(edge * here, cell, borderType=cv2.BORDER_CONSTANT)
    most = np.maximum.accumulate((dense / np.maximum(seen, SEEN)).max(1))
    ends = np.clip(np.arange(height) - APART_PX - band // 2, 0, height - 1)
    return [above, np.minimum(most[ends], MOST_DENSE), below, _alike(across, here)]


def _alike(across: _Plane, here: _Plane) -> _Rows:
    """Correlate how strong upright edges are, column by column, above and below."""
    total, count = _sums(np.minimum(np.abs(across), CAP) / CAP * here), _sums(here)
    first, second = _sides(len(here))
    above = total[first] / np.maximum(count[first], 1)
    under = count[-1] - count[second]
    below = (total[-1] - total[second]) / np.maximum(under, 1)
    both = ((count[first] > FEW) & (under > FEW)).astype(np.float32)
    n = both.sum(1, keepdims=True) + 1e-6
    parts = []
    for one in (above, below):
        soft = cv2.blur(one.astype(np.float32), (3, 1))
        parts.append((soft - (soft * both).sum(1, keepdims=True) / n) * both)
    a, b = parts
    return (a * b).sum(1) / np.sqrt((a * a).sum(1) * (b * b).sum(1) + 1e-9)


def _both(shown: Planes, smooth: _Plane, here: _Plane) -> list[_Rows]:
    """Compare tones, the branch's answers and blankness above and below."""
    mean = cv2.GaussianBlur(smooth, (0, 0), NEAR_PX)
    square = cv2.GaussianBlur(smooth * smooth, (0, 0), NEAR_PX)
    flat = (square - mean * mean < FLAT**2).astype(np.float32)
    tone, front, ground, blank = (
        _either_side(one, here) for one in (shown.tone, shown.front, shown.ground, flat)
    )
    return [tone[0] - tone[1], *front, ground[0], *blank]


def _rows(down: _Plane, here: _Plane) -> list[_Rows]:
    """Tell how unlike rows are to each other by their level edges, above and below."""
    strength = np.minimum(np.abs(down), CAP) / CAP * here
    profile = strength.sum(1) / (here.sum(1) + 1e-6)
    total = np.concatenate([[0], np.cumsum(profile)])
    square = np.concatenate([[0], np.cumsum(profile**2)])
    above, below = _sides(len(here))
    result = []
    for start, stop in ((0, above), (below, len(here))):
        n = np.maximum(stop - start, 1)
        mean = (total[stop] - total[start]) / n
        result.append(
            np.sqrt(np.maximum((square[stop] - square[start]) / n - mean**2, 0))
        )
    return result


def _wider(whole: Int[np.ndarray, " h"]) -> _Rows:
    """Compare how wide a front is above and below, as a logarithm."""
    total = np.concatenate([[0], np.cumsum(whole)])
    above, below = _sides(len(whole))
    upper = total[above] / np.maximum(above, 1)
    lower = (total[-1] - total[below]) / np.maximum(len(whole) - below, 1)
    return np.log((upper + 1) / (lower + 1))


def _either_side(plane: _Plane, here: _Plane) -> tuple[_Rows, _Rows]:
    """Return a plane's mean above each row and below it."""
    total = np.concatenate([[0], np.cumsum((plane * here).sum(1))])
    count = np.concatenate([[0], np.cumsum(here.sum(1))])
    above, below = _sides(len(here))
    return total[above] / np.maximum(count[above], 1), (
        total[-1] - total[below]
    ) / np.maximum(count[-1] - count[below], 1)


def _sides(height: int) -> tuple[Int[np.ndarray, " h"], Int[np.ndarray, " h"]]:
    """Tell for each row where what is above it stops, and what is below starts."""
    rows = np.arange(height)
    return np.clip(rows - APART_PX, 0, height), np.clip(rows + APART_PX + 1, 0, height)


def _sums(plane: _Plane) -> Float[np.ndarray, "h+1 w"]:
    """Sum up a plane's columns from the top."""
    nothing = np.zeros((1, plane.shape[1]))
    return np.concatenate([nothing, np.cumsum(plane, axis=0, dtype=np.float64)])
