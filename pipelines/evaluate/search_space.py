"""The paper's table 2: how much smaller deduplication makes the search for candidates.

    python -m pipelines.evaluate.search_space PHOTOS [--most 16]

Photographs are resized to 2048 px on the short side. Candidates are the intersections
of all pairs of the longest strict lines; they are voted on by all loose lines, without
deduplication, with either kind, and with both. Reported: by how much candidates and
wall time shrink, in percent, mean and standard deviation over photographs, and by how
much the winner moves.
"""

import argparse
import json
import time
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core import camera, lines, vanish
from nostalgin_core.arrays import Gray
from nostalgin_core.records import Box

SHORT_SIDE_PX = 2048
LONGEST = 150  # strict lines; pairs grow with the square
FAR = 20.0  # focal lengths: beyond, a point counts as infinite


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


def reductions(image: Gray) -> dict[str, tuple[float, float, float]]:
    """Measure each kind of deduplication on one photograph.

    Returns: by kind, the percentage that candidates and wall time shrink by, and the
    degrees that the winner moves.
    """
    strict_px, loose_px = lines.detect(image, lines.STRICT, lines.LOOSE)
    frame = Box(0, 0, image.shape[1], image.shape[0])
    where = camera.centre(frame), camera.prior_focal_px(frame)
    order = np.argsort(-vanish.lengths(strict_px), kind="stable")[:LONGEST]
    strict = vanish.to_unit(strict_px[order], *where)
    loose = vanish.to_unit(loose_px, *where)
    weights = vanish.lengths(loose_px)

    def search(*, collinear: bool, infinite: bool) -> tuple[int, float, np.ndarray]:
        start = time.perf_counter()
        used = vanish.without_collinear(strict) if collinear else strict
        points = vanish.intersections(used)
        points = without_infinite_doubles(points) if infinite else points
        votes = np.concatenate(
            [
                vanish.vote(part, loose, weights)
                for part in np.array_split(points, max(1, len(points) // 500))
            ]
        )
        return len(points), time.perf_counter() - start, points[votes.argmax()]

    count, seconds, winner = search(collinear=False, infinite=False)
    kinds = {
        "collinear lines": (True, False),
        "infinite points": (False, True),
        "both": (True, True),
    }
    result = {}
    for name, (collinear, infinite) in kinds.items():
        fewer, faster, moved = search(collinear=collinear, infinite=infinite)
        off = float(np.degrees(np.arccos(min(1.0, abs(float(winner @ moved))))))
        result[name] = (100 * (1 - fewer / count), 100 * (1 - faster / seconds), off)
    return result


def table(photos: list[Path]) -> dict[str, dict[str, float]]:
    """Sum up table 2 over photographs; unreadable ones are left out."""
    images = [cv2.imread(str(one), cv2.IMREAD_GRAYSCALE) for one in photos]
    each = [
        reductions(resized(one.astype(np.uint8))) for one in images if one is not None
    ]
    summary = {}
    for kind in each[0] if each else ():
        values = np.array([one[kind] for one in each])
        summary[kind] = {
            "photographs": len(each),
            "space_percent_mean": float(values[:, 0].mean()),
            "space_percent_sd": float(values[:, 0].std()),
            "time_percent_mean": float(values[:, 1].mean()),
            "time_percent_sd": float(values[:, 1].std()),
            "moved_deg_median": float(np.median(values[:, 2])),
            "moved_deg_max": float(values[:, 2].max()),
        }
    return summary


def main() -> None:
    """Print the table as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("photos", type=Path, help="a folder of JPEGs")
    parser.add_argument("--most", type=int, default=16)
    arguments = parser.parse_args()
    photos = sorted(arguments.photos.glob("*.jpg"))
    step = max(1, len(photos) // arguments.most)
    print(json.dumps(table(photos[::step][: arguments.most]), indent=1))  # noqa: T201


if __name__ == "__main__":
    main()
