"""York Urban: three square directions of a whole photo, without a mask or a camera.

    york_urban/cameraParameters.mat
    york_urban/NAME/NAME.jpg, NAME/NAMEGroundTruthVP_Orthogonal_CamParams.mat

Reported: angular errors of matched directions, seen through the true camera, unmatched
ones 90 degrees; the area under the curve of horizon errors up to a quarter of the
image's height; the error of the focal length. `lu_vp_detect`, where it is installed,
sees the same images with the same principal point, the image's centre (`peers`).
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float
from scipy import io as matlab

from nostalgin_core.arrays import Gray, Matrix3
from nostalgin_core.measure import rectification
from nostalgin_core.rectify import lines, manhattan
from pipelines.evaluate import Unmeasurable, peers

TRUTH = "*/*GroundTruthVP_Orthogonal_CamParams.mat"

Finder = Callable[[Gray], manhattan.Manhattan | None]


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """One image of York Urban and its three directions, x right, y down."""

    image: Gray
    directions: Matrix3  # a row a direction


def evaluate(folder: Path, detectors: dict[str, lines.Detector]) -> dict[str, Any]:
    """Measure ours with each detector of lines, and the peer with two focal lengths.

    Raises:
        Unmeasurable: if the folder holds no York Urban image.
    """
    true_camera, views = read(folder)
    report: dict[str, Any] = {
        name: measured(
            lambda image, detect=detect: manhattan.find(image, detect=detect),
            views,
            true_camera,
        )
        for name, detect in detectors.items()
    }
    if not peers.installed():
        return report | {"lu_vp_detect": "absent: pip install lu-vp-detect"}
    for name, focal_px in peer_focals(views[0].image, true_camera).items():
        found = measured(
            lambda image, f=focal_px: peers.lu_vp_detect(image, focal_px=f),
            views,
            true_camera,
        )
        report[f"lu_vp_detect, {name}"] = found | {"focal_error_percent": None}
    return report


def peer_focals(image: Gray, true_camera: Matrix3) -> dict[str, float]:
    """Name the focal lengths that the peer, which can't find one, is given."""
    h, w = image.shape
    prior = manhattan.FOCAL_PER_DIAGONAL * float(np.hypot(h, w))
    return {
        "our prior's focal length": prior,
        "the true focal length": float(true_camera[0, 0]),
    }


def read(folder: Path) -> tuple[Matrix3, list[View]]:
    """Read the camera and every image with its truth, in the order of their names.

    Raises:
        Unmeasurable: if a file is missing.
    """
    files = sorted(folder.glob(TRUTH))
    about = folder / "cameraParameters.mat"
    if not files or not about.is_file():
        raise Unmeasurable(
            f"{folder} holds no York Urban image: it needs cameraParameters.mat and "
            f"{TRUTH}"
        )
    parameters = matlab.loadmat(about)
    focal = float(parameters["focal"][0, 0] / parameters["pixelSize"][0, 0])
    x, y = parameters["pp"][0] - 1.0  # counted from one
    true_camera = np.array([[focal, 0.0, x], [0.0, focal, y], [0.0, 0.0, 1.0]])
    views = []
    for file in files:
        picture = file.parent / f"{file.parent.name}.jpg"
        image = cv2.imread(str(picture), cv2.IMREAD_GRAYSCALE)
        if image is None:
            raise Unmeasurable(f"{picture} is no image, but {file.name} lies beside it")
        directions = matlab.loadmat(file)["vp_orthogonal"].T * [1, -1, 1]
        views.append(View(image.astype(np.uint8), directions))
    return true_camera, views


def measured(find: Finder, views: list[View], true_camera: Matrix3) -> dict[str, Any]:
    """Run a finder over all images and sum up its errors and its time."""
    errors, horizons, focals, seconds = [], [], [], []
    for view in views:
        start = time.process_time()
        found = find(view.image)
        seconds.append(time.process_time() - start)
        points = None if found is None else found.vanishing_points
        errors.append(
            rectification.direction_errors_deg(points, view.directions, true_camera)
        )
        horizons.append(_horizon_error(points, view, true_camera))
        focal = true_camera[0, 0]
        focals.append(1.0 if found is None else abs(found.focal_px / focal - 1))
    return {
        "images": len(views),
        "median_deg": float(np.median(errors)),
        "mean_deg": float(np.mean(errors)),
        "horizon_auc": rectification.area_under_curve(np.array(horizons)),
        "focal_error_percent": 100 * float(np.median(focals)),
        "cpu_seconds_median": float(np.median(seconds)),
    }


def _horizon_error(
    points: Float[np.ndarray, "3 3"] | None, view: View, true_camera: Matrix3
) -> float:
    """Compare the horizon of the level directions; up is the first point found."""
    if points is None:
        return 1.0
    upright = np.argmax(np.abs(view.directions[:, 1]))
    level = np.delete(view.directions, upright, axis=0) @ true_camera.T
    return rectification.horizon_error(
        np.cross(points[1], points[2]), np.cross(level[0], level[1]), view.image.shape
    )
