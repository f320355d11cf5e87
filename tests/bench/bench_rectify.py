"""Print what rectification costs beside LSD with RANSAC vanishing points.

Run with `python tests/bench/bench_rectify.py`. The photo is painted: a corner building
with windows. Ours is the whole stage, warp included, for both fronts; the peer finds
lines with OpenCV's LSD and three vanishing points by RANSAC over pairs of lines, as
peers do, and makes no elevation. CPU seconds, the least of five runs.
"""

import time
from collections.abc import Callable
from dataclasses import replace

import cv2
import numpy as np

from nostalgin_core import manhattan, rectify, vanish
from nostalgin_core.measure_rectification import worst_angle_deg
from nostalgin_core.records import Box, Elevation, Matted, Photo
from pipelines.evaluate import detectors
from tests.painted_front import Painted, photograph


def enlarged(painted: Painted, h: int, w: int) -> tuple[Photo, Matted]:
    """Bring a painted photo and its masks to another size."""

    def mask(values: np.ndarray) -> np.ndarray:
        small = values.astype(np.uint8)
        return cv2.resize(small, (w, h), interpolation=cv2.INTER_NEAREST) > 0

    image = cv2.resize(painted.photo.image, (w, h), interpolation=cv2.INTER_CUBIC)
    facades = tuple(
        replace(
            one,
            mask=mask(one.mask),
            amodal=mask(one.amodal),
            alpha=mask(one.mask).astype(np.float32),
        )
        for one in painted.matted.facades
    )
    return Photo("0" * 16, image, Box(0, 0, w, h)), Matted(facades, ())


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


def main() -> None:
    """Print one row a size."""
    cv2.setNumThreads(1)
    painted = photograph(seed=5)
    print("size        rectify  LSD+RANSAC  ratio  York's way  worst angle")
    for h, w in ((1200, 800), (3000, 2048)):
        photo, matted = enlarged(painted, h, w)
        ours = least(lambda p=photo, m=matted: rectify.rectify(p, m))
        peer = least(lambda p=photo: lsd_and_ransac(p.image))
        whole = least(lambda p=photo: manhattan.find(p.image))
        results = rectify.rectify(photo, matted)
        scale = np.array([w / 600, h / 800])
        angles = [
            worst_angle_deg((quad + 0.5) * scale - 0.5, one.photo_from_elevation)
            for quad, one in zip(painted.quads, results, strict=True)
            if isinstance(one, Elevation)
        ]
        print(
            f"{w}x{h}".ljust(11),
            f"{ours:7.3f} {peer:11.3f} {ours / peer:6.2f} {whole:11.3f}",
            f"{max(angles, default=float('nan')):12.2f}",
        )


if __name__ == "__main__":
    main()
