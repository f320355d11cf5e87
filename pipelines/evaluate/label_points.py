"""Do stated intervals hold on real photographs? Labelled quads have vanishing points.

Opposite sides of a labelled quad meet where the front's true vanishing points ought to
be. Labels err, too: the corners' noise is carried to the quad's own points and added to
what the elevation states, and the two together are held against the difference. Only
fronts wholly in the frame are compared, since other quads' corners are guesses.
"""

from typing import Any, Final

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Corners, Matrix3
from nostalgin_core.measure import coverage as measure
from nostalgin_core.measure.rectification import angle_deg
from nostalgin_core.records import Box, Elevation
from nostalgin_core.rectify import camera
from pipelines.evaluate.labelled import Labelled
from pipelines.evaluate.streets import Residual

LABEL_SD_PX: Final = 2.0  # of a corner, in both coordinates together
STEP_PX: Final = 0.5  # for differences; a labelled side has tens of pixels
NAMES: Final = ("horizontal", "vertical")


def coverage(photographs: list[Labelled]) -> dict[str, Any]:
    """Sum up how often the labelled points lie within stated and labels' error."""
    residuals = [one for photograph in photographs for one in compared(photograph)]
    table: dict[str, Any] = {}
    for name in NAMES:
        mine = [one for one in residuals if one.quantity == name]
        for method in ("all", *sorted({one.method for one in mine})):
            group = [one for one in mine if method in ("all", one.method)]
            result = measure.coverage(
                np.array([one.error for one in group]),
                np.array([one.sd for one in group]),
            )
            if result is not None:
                table.setdefault(name, {})[method] = result._asdict()
    return table


def compared(one: Labelled) -> list[Residual]:
    """Compare the points of a photo's elevations with its labelled quads'."""
    found = []
    for front, result in zip(one.fronts, one.results, strict=True):
        if not isinstance(result, Elevation) or not front.get("complete"):
            continue
        quad = np.array(front["quad"], np.float64)
        matrix = matrix_of(result, one.photo.frame)
        for rank, name in enumerate(NAMES):
            error = angle_deg(result.vanishing_points[rank], points(quad)[rank], matrix)
            stated = result.vanishing_sd_deg[rank]
            sd = float(np.hypot(stated, label_sd_deg(quad, rank, matrix)))
            found.append(Residual(name, result.method, error, sd))
    return found


def matrix_of(result: Elevation, frame: Box) -> Matrix3:
    """Compose the camera that an elevation states, or else the prior's."""
    return camera.matrix(result.focal_px or camera.prior_focal_px(frame), frame)


def points(quad: Corners) -> Float[np.ndarray, "2 3"]:
    """Intersect a quad's opposite sides: its horizontal, then its vertical point."""
    corners = np.column_stack([quad, np.ones(4)])
    top, right, bottom, left = np.cross(corners, np.roll(corners, -1, axis=0))
    return np.array([np.cross(top, bottom), np.cross(left, right)])


def label_sd_deg(quad: Corners, rank: int, matrix: Matrix3) -> float:
    """Carry the corners' noise to one of the quad's vanishing points, to first order.

    A coordinate's share is the angle that the point moves by as it moves; shares are
    independent, and their squares add.
    """
    square = 0.0
    for i in range(8):
        moved = quad.copy()
        moved[i // 2, i % 2] += STEP_PX
        turn = angle_deg(points(moved)[rank], points(quad)[rank], matrix)
        square += (turn / STEP_PX) ** 2
    return float(np.sqrt(square / 2)) * LABEL_SD_PX
