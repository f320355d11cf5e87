"""Find a photo's edges, to a fraction of a pixel, and link them into contours.

The photo is evened out first, so that Canny's thresholds round the median (the paper,
section 3.3.1) suit a front in shade as well as one in the sun. Every step works on all
pixels at once.
"""

from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, Int
from scipy import sparse

from nostalgin_core.arrays import Gray, Mask, Points

MEDIAN_SPREAD = 0.33  # the paper's lambda
EVEN_PX = 24.0  # about a window with its wall
FLOOR = 6.0  # gray levels of contrast below which nothing is amplified fully
CONTRAST = 60.0  # gray levels that one standard deviation becomes
COARSER = 4  # times than half size, the middle and the contrast are blurred and kept
BLUR_PX = 0.6  # half of what grain and scan need; more rounds off window corners

# The eight neighbours as (dy, dx); a diagonal's two common 4-neighbours follow it.
_FOUR = ((0, 1), (1, 0))
_DIAGONAL = ((1, 1), (1, -1))


@dataclass(frozen=True, slots=True, eq=False)
class Contours:
    """Edge points in their order along contours; contours lie one after another."""

    points: Points  # to a fraction of a pixel
    contour: Int[np.ndarray, " n"]  # the number of each point's contour, ascending


def canny_thresholds(image: Gray, *, spread: float = MEDIAN_SPREAD) -> tuple[int, int]:
    """Place Canny's thresholds round the image's median (section 3.3.1, equation 1).

    Of 256 levels, a histogram tells the median without sorting pixels.
    """
    count = np.cumsum(cv2.calcHist([image], [0], None, [256], [0, 256]))
    middle = (image.size - 1) // 2 + 1, image.size // 2 + 1
    median = float(np.mean(np.searchsorted(count, middle)))
    low, high = max(0.0, median * (1 - spread)), min(255.0, median * (1 + spread))
    return round(low), max(round(high), 1)


def even_out(image: Gray, *, reach: float = EVEN_PX, floor: float = FLOOR) -> Gray:
    """Give every neighbourhood the same middle gray and the same contrast.

    One median for the whole photo would leave a front in shade without any edge. The
    local mean and standard deviation are Gaussian with `reach` pixels; `floor`, in gray
    levels, keeps grain in an empty sky from being blown up. Both are smooth over
    `reach` pixels, so they are reckoned at an eighth of the size.
    """
    h, w = image.shape
    half = (max(1, w // 2), max(1, h // 2))
    eighth = (max(1, half[0] // COARSER), max(1, half[1] // COARSER))
    small = cv2.resize(image, half, interpolation=cv2.INTER_AREA).astype(np.float32)
    mean, square = (
        cv2.GaussianBlur(
            cv2.resize(values, eighth, interpolation=cv2.INTER_AREA),
            (0, 0),
            reach / (2 * COARSER),
        )
        for values in (small, small * small)
    )
    gain = np.float32(CONTRAST) / (
        np.sqrt(np.maximum(square - mean * mean, 0)) + np.float32(floor)
    )
    gain, level = (cv2.resize(a, (w, h)) for a in (gain, 128 - mean * gain))
    cv2.multiply(image, gain, gain, dtype=cv2.CV_32F)
    cv2.add(gain, level, level)
    return np.clip(level, 0, 255, out=level).astype(np.uint8)


def edges(
    image: Gray, low: int, high: int, *, where: Mask | None = None
) -> tuple[Mask, Points]:
    """Find edge pixels, and where between pixels the edge runs.

    The gradient's magnitude is sampled one pixel to either side across the edge, and
    a parabola through the three values peaks where the edge is.

    Returns: the edge mask, and for each edge pixel in raster order its (x, y).
    """
    smooth = cv2.GaussianBlur(image, (0, 0), BLUR_PX)
    dx = cv2.Sobel(smooth, cv2.CV_16S, 1, 0)
    dy = cv2.Sobel(smooth, cv2.CV_16S, 0, 1)
    mask = cv2.Canny(dx, dy, low, high, L2gradient=True) > 0
    if where is not None:
        mask &= where
    mask[[0, -1], :] = False
    mask[:, [0, -1]] = False
    # cv2.magnitude would round by where in memory the arrays happen to lie
    magnitude = np.sqrt(dx.astype(np.float32) ** 2 + dy.astype(np.float32) ** 2)
    y, x = np.nonzero(mask)
    gx, gy, peak = dx[y, x] * 1.0, dy[y, x] * 1.0, magnitude[y, x].astype(np.float64)
    steep = np.maximum(np.abs(gx), np.abs(gy))
    step_x, step_y = gx / steep, gy / steep  # to the next pixel across the edge
    before = _between(magnitude, x - step_x, y - step_y)
    after = _between(magnitude, x + step_x, y + step_y)
    curve = 2 * peak - before - after
    shift = np.where(curve > 1e-6, 0.5 * (after - before) / np.maximum(curve, 1e-6), 0)
    shift = np.clip(shift, -0.7, 0.7)
    return mask, np.column_stack([x + shift * step_x, y + shift * step_y])


def _between(
    values: Float[np.ndarray, "h w"],
    x: Float[np.ndarray, " n"],
    y: Float[np.ndarray, " n"],
) -> Float[np.ndarray, " n"]:
    """Read an array between its pixels, bilinearly; all points lie inside."""
    x0, y0 = np.floor(x).astype(np.intp), np.floor(y).astype(np.intp)
    x1 = np.minimum(x0 + 1, values.shape[1] - 1)
    y1 = np.minimum(y0 + 1, values.shape[0] - 1)
    tx, ty = x - x0, y - y0
    top = values[y0, x0] * (1 - tx) + values[y0, x1] * tx
    bottom = values[y1, x0] * (1 - tx) + values[y1, x1] * tx
    return top * (1 - ty) + bottom * ty


def link(mask: Mask, points: Points, *, shortest: int = 8) -> Contours:
    """Link edge pixels into contours, in order, without a loop over pixels.

    Two pixels are neighbours if they touch, but a diagonal counts only where no pixel
    bridges it, so a staircase is one thin path. Pixels with three or more neighbours
    are junctions and are taken out: what is left are paths and closed loops, and a loop
    is cut at its first pixel. All paths are then tied end to start into one long chain,
    whose order a single graph traversal reads off.

    Contours of fewer than `shortest` points are dropped; they hold no line.
    """
    first, second = _neighbours(mask)
    n = len(points)
    degree = np.bincount(np.concatenate([first, second]), minlength=n)
    kept = (degree[first] <= 2) & (degree[second] <= 2)
    first, second = first[kept], second[kept]
    count, label = _components(first, second, n)
    size = np.bincount(label, minlength=count)
    links = np.bincount(label[first], minlength=count)
    loop = np.flatnonzero((links == size) & (size > 2))
    if len(loop):  # cut each loop: drop the first link that is met in it
        _, cut = np.unique(label[first], return_index=True)
        keep = np.ones(len(first), bool)
        keep[cut[np.isin(label[first[cut]], loop)]] = False
        first, second = first[keep], second[keep]
    degree = np.bincount(np.concatenate([first, second]), minlength=n)
    ends = np.flatnonzero((degree == 1) & (size[label] >= shortest))
    if not len(ends):
        return Contours(np.empty((0, 2)), np.empty(0, np.intp))
    ends = ends[np.argsort(label[ends], kind="stable")]
    start, stop = ends[::2], ends[1::2]
    used = size[label[first]] >= shortest
    rows = np.concatenate([first[used], stop[:-1]])
    columns = np.concatenate([second[used], start[1:]])
    chain = sparse.coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), (n, n))
    order = sparse.csgraph.depth_first_order(
        chain.tocsr(), start[0], directed=False, return_predecessors=False
    )
    contour = np.cumsum(np.diff(label[order], prepend=label[order[0]]) != 0)
    return Contours(points[order], contour.astype(np.intp))


def _neighbours(
    mask: Mask,
) -> tuple[Int[np.ndarray, " m"], Int[np.ndarray, " m"]]:
    """List the pairs of neighbouring edge pixels, as ranks in raster order."""
    h, w = mask.shape
    y, x = np.nonzero(mask)
    here = np.arange(len(y), dtype=np.int32)
    rank = np.full((h + 2, w + 2), -1, np.int32)  # a rim, so that all have neighbours
    rank[y + 1, x + 1] = here
    pairs = []
    for dy, dx in (*_FOUR, *_DIAGONAL):
        other = rank[y + dy + 1, x + dx + 1]
        both = other >= 0
        if dx and dy:  # (0, dx) and (dy, 0) from here are the common neighbours
            both &= (rank[y + 1, x + dx + 1] < 0) & (rank[y + dy + 1, x + 1] < 0)
        pairs.append((here[both], other[both]))
    return (
        np.concatenate([p[0] for p in pairs]),
        np.concatenate([p[1] for p in pairs]),
    )


def _components(
    first: Int[np.ndarray, " m"], second: Int[np.ndarray, " m"], n: int
) -> tuple[int, Int[np.ndarray, " n"]]:
    """Label the connected components of a graph of `n` nodes."""
    graph = sparse.coo_matrix((np.ones(len(first), np.int8), (first, second)), (n, n))
    count, label = sparse.csgraph.connected_components(graph.tocsr(), directed=False)
    return count, label.astype(np.intp)
