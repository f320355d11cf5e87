"""The paper's table 2: how much smaller deduplication makes the search for candidates.

Photographs are resized to 2048 px on the short side. Candidates are the intersections
of all pairs of the longest strict lines; they are voted on by all loose lines, without
deduplication, with either kind, and with both. Reported: by how much candidates and
time shrink, in percent, mean and standard deviation over photographs, and by how much
the winner moves, as voted and once the best few are refined (`sphere`). The
paper gives wall time; here it is CPU time, which other work on the machine can't bend.
"""

import time
from pathlib import Path
from typing import Any, Final

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Gray
from nostalgin_core.records import Box
from nostalgin_core.rectify import camera, lines, vanish
from pipelines.evaluate import Unmeasurable, sphere

SHORT_SIDE_PX = 2048
LONGEST = 150  # strict lines; pairs grow with the square
FAR = 20.0  # focal lengths: beyond, a point counts as infinite
MOST = 10  # photographs of a set
KINDS: Final = {
    "collinear lines": (True, False),
    "infinite points": (False, True),
    "both": (True, True),
}


def resized(image: Gray) -> Gray:
    """Bring an image to 2048 px on its short side."""
    scale = SHORT_SIDE_PX / min(image.shape)
    grown = cv2.resize(image, None, fx=scale, fy=scale, interpolation=cv2.INTER_CUBIC)
    return grown.astype(np.uint8)


def without_infinite_doubles(
    points: Float[np.ndarray, "m 3"],
) -> Float[np.ndarray, "_ 3"]:
    """Keep one of the candidates near infinity that no vote could tell apart."""
    infinite = np.abs(points[:, 2]) < 1 / FAR
    return np.vstack([points[~infinite], vanish.without_doubles(points[infinite])])


def reductions(image: Gray) -> dict[str, tuple[float, float, float, float]]:
    """Measure each kind of deduplication on one photograph.

    Returns: by kind, the percentage that candidates and time shrink by, and the degrees
    that the winner moves, as voted and refined.
    """
    strict_px, loose_px = lines.detect(image, lines.STRICT, lines.LOOSE)
    frame = Box(0, 0, image.shape[1], image.shape[0])
    where = camera.centre(frame), camera.prior_focal_px(frame)
    order = np.argsort(-vanish.lengths(strict_px), kind="stable")[:LONGEST]
    strict = vanish.to_unit(strict_px[order], *where)
    loose = vanish.to_unit(loose_px, *where)
    weights = vanish.lengths(loose_px)

    def search(
        *, collinear: bool, infinite: bool
    ) -> tuple[int, float, np.ndarray, np.ndarray]:
        start = time.process_time()
        used = vanish.without_collinear(strict) if collinear else strict
        points = vanish.intersections(used)
        points = without_infinite_doubles(points) if infinite else points
        votes = np.concatenate(
            [
                vanish.vote(part, loose, weights)
                for part in np.array_split(points, max(1, len(points) // 500))
            ]
        )
        seconds = time.process_time() - start
        settled = sphere.best(points, votes, loose, weights)
        return len(points), seconds, points[votes.argmax()], settled

    count, seconds, winner, settled = search(collinear=False, infinite=False)
    result = {}
    for name, (collinear, infinite) in KINDS.items():
        fewer, faster, *moved = search(collinear=collinear, infinite=infinite)
        result[name] = (
            100 * (1 - fewer / count),
            100 * (1 - faster / seconds),
            apart_deg(winner, moved[0]),
            apart_deg(settled, moved[1]),
        )
    return result


def apart_deg(one: np.ndarray, other: np.ndarray) -> float:
    """Measure the angle between two points on the sphere, whose signs mean nothing."""
    return float(
        np.degrees(np.arctan2(np.linalg.norm(np.cross(one, other)), abs(one @ other)))
    )


def chosen(folder: Path, *, most: int = MOST) -> list[Path]:
    """Choose a folder's photographs evenly over their names.

    Raises:
        Unmeasurable: if there is no JPEG.
    """
    files = sorted(folder.glob("*.jpg"))
    if not files:
        raise Unmeasurable(f"no *.jpg in {folder}")
    return files[:: -(-len(files) // most)]


def evaluate(folder: Path, *, most: int = MOST) -> dict[str, Any]:
    """Sum up table 2 over photographs of a folder.

    Raises:
        Unmeasurable: if there is no photograph, or one that can't be read.
    """
    each = []
    for file in chosen(folder, most=most):
        image = cv2.imread(str(file), cv2.IMREAD_GRAYSCALE)
        if image is None:
            raise Unmeasurable(f"{file} is no image: take it out of the folder")
        each.append(reductions(resized(image.astype(np.uint8))))
    summary: dict[str, Any] = {"photographs": len(each)}
    for kind in KINDS:
        values = np.array([one[kind] for one in each])
        summary[kind] = {
            "space_percent_mean": float(values[:, 0].mean()),
            "space_percent_sd": float(values[:, 0].std()),
            "time_percent_mean": float(values[:, 1].mean()),
            "time_percent_sd": float(values[:, 1].std()),
            "moved_deg_median": float(np.median(values[:, 2])),
            "moved_deg_max": float(values[:, 2].max()),
            "refined_moved_deg_median": float(np.median(values[:, 3])),
            "refined_moved_deg_max": float(values[:, 3].max()),
        }
    return summary
