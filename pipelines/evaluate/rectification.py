"""How well fronts are straightened: York Urban, and hand-labelled photographs.

    python -m pipelines.evaluate.rectification DATA [--detector ours|lsd|hough]

DATA is the folder that holds `york_urban/` and `taxphotos/`; either may be absent.
York Urban: angular errors of three matched directions through the true camera,
unmatched ones 90 degrees; area under the curve of horizon errors up to a quarter of
the image's height; error of the focal length. Labelled photographs: our rectifier with
the labels as perfect masks, and each labelled quad's worst angle once straightened.
"""

import argparse
import json
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from scipy import io as matlab

from nostalgin_core import (
    lines,
    manhattan,
    measure_rectification,
    photo,
    rectify,
)
from nostalgin_core.records import Elevation, Facade, Matted, Occluder, Photo
from pipelines.evaluate import detectors

DETECTORS: dict[str, lines.Detector] = {
    "ours": lines.detect,
    "lsd": detectors.lsd,
    "hough": detectors.hough,
}


def york_urban(
    folder: Path, *, detector: lines.Detector = lines.detect
) -> dict[str, float]:
    """Evaluate uncalibrated vanishing points on York Urban's images in `folder`."""
    parameters = matlab.loadmat(folder / "cameraParameters.mat")
    focal = float(parameters["focal"][0, 0] / parameters["pixelSize"][0, 0])
    x, y = parameters["pp"][0] - 1.0  # counted from one
    camera = np.array([[focal, 0.0, x], [0.0, focal, y], [0.0, 0.0, 1.0]])
    errors, horizons, focals, seconds = [], [], [], []
    for truth_file in sorted(folder.glob("*/*GroundTruthVP_Orthogonal_CamParams.mat")):
        name = truth_file.parent.name
        image = cv2.imread(str(truth_file.parent / f"{name}.jpg"), cv2.IMREAD_GRAYSCALE)
        if image is None:
            raise FileNotFoundError(truth_file.parent / f"{name}.jpg")
        directions = matlab.loadmat(truth_file)["vp_orthogonal"].T * [1, -1, 1]
        start = time.process_time()
        found = manhattan.find(image.astype(np.uint8), detect=detector)
        seconds.append(time.process_time() - start)
        points = None if found is None else found.vanishing_points
        errors.append(
            measure_rectification.direction_errors_deg(points, directions, camera)
        )
        upright = np.argmax(np.abs(directions[:, 1]))
        level = np.delete(directions, upright, axis=0) @ camera.T
        horizons.append(
            1.0
            if found is None
            else measure_rectification.horizon_error(
                np.cross(found.vanishing_points[1], found.vanishing_points[2]),
                np.cross(level[0], level[1]),
                image.shape,
            )
        )
        focals.append(1.0 if found is None else abs(found.focal_px / focal - 1))
    area = measure_rectification.area_under_curve(np.array(horizons))
    return {
        "images": len(errors),
        "median_deg": float(np.median(errors)),
        "mean_deg": float(np.mean(errors)),
        "horizon_auc": area,
        "focal_error_percent": 100 * float(np.median(focals)),
        "cpu_seconds_median": float(np.median(seconds)),
    }


def labelled(folder: Path, *, prefix: str = "") -> dict[str, Any]:
    """Evaluate the rectifier on labelled photographs, with the labels as masks.

    Groups are never scored. `prefix` restricts the labels, e.g. to one block.
    """
    angles: dict[str, list[float]] = {"target": [], "all": []}
    counts: dict[str, int] = {"target": 0, "all": 0}
    reasons: Counter[str] = Counter()
    seconds = []
    for label, image in _labelled_photos(folder, prefix):
        fronts, matted = matted_from(label, image)
        start = time.process_time()
        results = rectify.rectify(image, matted)
        seconds.append(time.process_time() - start)
        for front, result in zip(fronts, results, strict=True):
            kinds = ("target", "all") if front.get("target") else ("all",)
            for kind in kinds:
                counts[kind] += 1
            if not isinstance(result, Elevation):
                reasons[result.reason] += 1
                continue
            worst = measure_rectification.worst_angle_deg(
                np.array(front["quad"], np.float64), result.photo_from_elevation
            )
            for kind in kinds:
                angles[kind].append(worst)
    summary: dict[str, Any] = {
        "rejections": dict(sorted(reasons.items())),
        "cpu_seconds_median": float(np.median(seconds)) if seconds else None,
    }
    for kind, values in angles.items():
        summary[f"{kind}_fronts"] = counts[kind]
        summary[f"{kind}_straightened"] = len(values)
        if values:
            summary[f"{kind}_angle_median"] = float(np.median(values))
            summary[f"{kind}_angle_p90"] = float(np.percentile(values, 90))
    return summary


def _labelled_photos(
    folder: Path, prefix: str
) -> Iterator[tuple[dict[str, Any], Photo]]:
    """Read every label and its photograph, in the order of their names."""
    for file in sorted((folder / "labels").glob(f"{prefix}*.json")):
        label = json.loads(file.read_text())
        (picture,) = (folder / "photos").glob(f"*{file.stem}.jpg")
        decoded = photo.decode(picture.read_bytes(), name=picture.name)
        if isinstance(decoded, Photo):
            yield label, decoded


def matted_from(
    label: dict[str, Any], image: Photo
) -> tuple[list[dict[str, Any]], Matted]:
    """Make of a label what perfect segmentation and matting would say."""
    shape = image.image.shape
    fronts = [
        one
        for one in label["objects"]
        if one["category"] == "facade" and not one.get("group")
    ]
    occluders = tuple(
        Occluder(one["category"], 1.0, _filled(one["polygon"], shape))
        for one in label["objects"]
        if one["category"] != "facade"
    )
    hidden = np.any([np.zeros(shape, bool), *(o.mask for o in occluders)], axis=0)
    facades = []
    for index, one in enumerate(fronts):
        amodal = _filled(one["polygon"], shape)
        target = bool(one.get("target"))
        alpha = (amodal & ~hidden).astype(np.float32)
        facades.append(
            Facade(index, 1.0, target, float(target), amodal & ~hidden, amodal, alpha)
        )
    return fronts, Matted(tuple(facades), occluders)


def _filled(polygon: list[list[float]], shape: tuple[int, ...]) -> np.ndarray:
    """Fill a labelled outline."""
    mask = np.zeros(shape, np.uint8)
    cv2.fillPoly(mask, [np.rint(np.array(polygon)).astype(np.int32)], 1)
    return mask > 0


def main() -> None:
    """Print both tables as JSON."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("--detector", choices=sorted(DETECTORS), default="ours")
    parser.add_argument("--block", default="", help="start of the labels' names")
    arguments = parser.parse_args()
    report: dict[str, Any] = {}
    if (arguments.data / "york_urban").is_dir():
        report["york_urban"] = york_urban(
            arguments.data / "york_urban", detector=DETECTORS[arguments.detector]
        )
    if (arguments.data / "taxphotos").is_dir():
        report["taxphotos"] = labelled(
            arguments.data / "taxphotos", prefix=arguments.block
        )
    print(json.dumps(report, indent=1))  # noqa: T201


if __name__ == "__main__":
    main()
