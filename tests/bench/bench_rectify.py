"""Print what rectification costs beside LSD with RANSAC vanishing points.

Run with `python tests/bench/bench_rectify.py`; painting takes most of its minute. The
photo is of a painted street, painted at the size that is measured, since an enlarged
one has fewer and softer edges. Ours is the whole stage, warp included, for all fronts,
and of it the part that finds directions and camera; the peer finds lines with OpenCV's
LSD and three vanishing points by RANSAC over pairs of lines, as peers do, and makes no
elevation. CPU seconds, the least of five runs.
"""

import time
from collections.abc import Callable

import cv2
import numpy as np

from nostalgin_core import rectify
from nostalgin_core.measure.rectification import worst_angle_deg
from nostalgin_core.records import Elevation
from nostalgin_core.rectify import manhattan, orient, vanish
from pipelines.evaluate import detectors
from pipelines.evaluate.painted import Painted, paintings

SEED = 5
SIZES = ((1200, 800), (3000, 2048))  # height, width


def lsd_and_ransac(image: np.ndarray, *, rounds: int = 1000) -> np.ndarray:
    """Find three vanishing points as a peer does."""
    rng = np.random.default_rng(0)
    (lines,) = detectors.lsd(image, (8, 9.0))
    found = []
    for _ in range(3):
        one = np.ones((len(lines), 1))
        rows = np.cross(np.hstack([lines[:, :2], one]), np.hstack([lines[:, 2:], one]))
        i, j = rng.integers(0, len(lines), (2, rounds))
        points = np.cross(rows[i], rows[j])
        points = points[np.linalg.norm(points, axis=1) > 1e-9]
        points /= np.linalg.norm(points, axis=1, keepdims=True)
        votes = np.concatenate(
            [
                (vanish.distance_deg(part, lines) < 2) @ vanish.lengths(lines)
                for part in np.array_split(points, 10)
            ]
        )
        best = points[votes.argmax()]
        found.append(best)
        lines = lines[vanish.distance_deg(best[None], lines)[0] >= 2]
        if len(lines) < 2:
            break
    return np.array(found)


def least(work: Callable[[], object], *, times: int = 5) -> float:
    """Give the least CPU seconds of several runs."""
    seconds = []
    for _ in range(times):
        start = time.process_time()
        work()
        seconds.append(time.process_time() - start)
    return min(seconds)


def row(painted: Painted) -> list[str]:
    """Measure one photo."""
    photo, matted = painted.photo, painted.matted
    ours = least(lambda: rectify.rectify(photo, matted))
    directions = least(lambda: orient.orient(photo, matted.facades))
    peer = least(lambda: lsd_and_ransac(photo.image))
    whole = least(lambda: manhattan.find(photo.image))
    results = rectify.rectify(photo, matted)
    angles = [
        worst_angle_deg(quad, one.photo_from_elevation)
        for quad, one in zip(painted.quads, results, strict=True)
        if isinstance(one, Elevation)
    ]
    h, w = photo.image.shape
    return [
        f"{w}x{h}",
        f"{len(painted.quads)}",
        f"{ours:.3f}",
        f"{directions:.3f}",
        f"{peer:.3f}",
        f"{ours / peer:.2f}",
        f"{directions / peer:.2f}",
        f"{whole:.3f}",
        f"{max(angles, default=float('nan')):.2f}",
    ]


def main() -> None:
    """Print one row a size."""
    cv2.setNumThreads(1)
    heads = (
        "size",
        "fronts",
        "rectify",
        "directions",
        "LSD+RANSAC",
        "rectify/peer",
        "directions/peer",
        "York's way",
        "worst deg",
    )
    print("  ".join(heads))
    for shape in SIZES:
        (painted,) = paintings(1, seed=SEED, shape=shape)
        cells = row(painted)
        print(
            "  ".join(
                cell.rjust(len(head)) for cell, head in zip(cells, heads, strict=True)
            )
        )


if __name__ == "__main__":
    main()
