import numpy as np
import pytest

from nostalgin_core.measure import rectification
from nostalgin_core.rectify import camera, manhattan, upright
from tests.data import DATA
from tests.painted_front import photograph


def test_a_painted_corner_tells_its_three_directions() -> None:
    painted = photograph(seed=3)
    found = manhattan.find(painted.photo.image, frame=painted.photo.frame)
    assert found is not None
    directions = upright.axes(np.array([0.0, *np.radians([1.0, 12.0, -35.0, 55.0])]))
    matrix = camera.matrix(painted.focal_px, painted.photo.frame)
    errors = rectification.direction_errors_deg(
        found.vanishing_points, directions, matrix
    )
    assert errors.max() < 1.5
    assert found.focal_px == pytest.approx(painted.focal_px, rel=0.05)


def test_an_empty_image_has_no_directions() -> None:
    assert manhattan.find(np.full((120, 160), 77, np.uint8)) is None


@pytest.mark.skipif(
    not (DATA / "york_urban").is_dir(), reason=f"no York Urban images at {DATA}"
)
def test_three_images_of_york_urban_come_out_within_two_degrees() -> None:
    cv2 = pytest.importorskip("cv2")
    matlab = pytest.importorskip("scipy.io")
    folder = DATA / "york_urban"
    parameters = matlab.loadmat(folder / "cameraParameters.mat")
    focal = float(parameters["focal"][0, 0] / parameters["pixelSize"][0, 0])
    x, y = parameters["pp"][0] - 1
    matrix = np.array([[focal, 0, x], [0, focal, y], [0, 0, 1]])
    errors = []
    for name in ("P1030001", "P1040845", "P1080032"):
        image = cv2.imread(str(folder / name / f"{name}.jpg"), cv2.IMREAD_GRAYSCALE)
        truth = matlab.loadmat(
            folder / name / f"{name}GroundTruthVP_Orthogonal_CamParams.mat"
        )["vp_orthogonal"].T * [1, -1, 1]
        found = manhattan.find(image)
        assert found is not None
        errors.append(
            rectification.direction_errors_deg(found.vanishing_points, truth, matrix)
        )
    assert np.median(errors) < 2
