"""What a photo of right angles tells of its camera, and what a quad's shape really is.

The principal point is taken to be the centre of the exposed frame, pixels to be square
and without skew (section 3.3.4), so the focal length is the one unknown of the camera.

Letters, as in Zhang and He's whiteboard paper: `m1` to `m4` the quad's corners, top
left, top right, bottom left, bottom right; `k2`, `k3` their depths over `m1`'s; `n2`,
`n3` the images of the two edge directions; `A` the camera's matrix.
"""

import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Corners, Matrix3
from nostalgin_core.records import Box

FOCAL_PER_DIAGONAL = 0.68  # of the exposed frame: 28 to 35 mm lenses on 35 mm film
LEAST_SHARE = 1e-3  # of a point's own size: nearer to infinity it tells no focal length


def centre(frame: Box) -> Float[np.ndarray, "2"]:
    """Place the principal point at the middle of the exposed frame, in photo pixels."""
    x, y = (frame.x0 + frame.x1 - 1) / 2, (frame.y0 + frame.y1 - 1) / 2
    return np.array([x, y])


def prior_focal_px(frame: Box) -> float:
    """Guess the focal length from the frame alone, to about 20 percent.

    The labelled corner buildings of two blocks, whose quads tell it, have 0.68 of the
    diagonal in the median, and 0.55 to 0.94 in nine of ten.
    """
    return FOCAL_PER_DIAGONAL * float(
        np.hypot(frame.x1 - frame.x0, frame.y1 - frame.y0)
    )


def focal_px(
    first: Float[np.ndarray, "3"], second: Float[np.ndarray, "3"], frame: Box
) -> float | None:
    """Find the focal length from the vanishing points of two orthogonal directions.

    Seen from the principal point, orthogonal directions meet x1 x2 + y1 y2 + f^2 w1 w2
    = 0. There are two degenerate cases, and both give None: a point at infinity, since
    then its direction lies in the image and says nothing of depth; and points on the
    same side of the centre, which no focal length makes orthogonal.
    """
    middle = centre(frame)
    reach = prior_focal_px(frame)
    a = np.array([*(first[:2] - middle * first[2]) / reach, first[2]])
    b = np.array([*(second[:2] - middle * second[2]) / reach, second[2]])
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    depth = a[2] * b[2]
    if abs(depth) < LEAST_SHARE:
        return None
    square = -(a[0] * b[0] + a[1] * b[1]) / depth
    return reach * float(np.sqrt(square)) if square > 0 else None


def matrix(focal: float, frame: Box) -> Matrix3:
    """Compose A, which carries camera directions to photo pixels."""
    x, y = centre(frame)
    return np.array([[focal, 0.0, x], [0.0, focal, y], [0.0, 0.0, 1.0]])


def aspect(quad: Corners, focal: float, frame: Box) -> float:
    """Find width over height of the rectangle whose image is a quad (Zhang and He).

        k2 = (m1 x m4) . m3 / ((m2 x m4) . m3)        n2 = k2 m2 - m1
        k3 = (m1 x m4) . m2 / ((m3 x m4) . m2)        n3 = k3 m3 - m1
        (width / height)^2 = |A^-1 n2|^2 / |A^-1 n3|^2

    A fronto-parallel quad has k2 = k3 = 1: then n2 and n3 lie in the image, the focal
    length cancels, and the ratio is that of the sides.

    Raises:
        ValueError: if three corners lie in line.
    """
    m1, m2, m4, m3 = np.column_stack([quad, np.ones(4)])  # clockwise to row by row
    under2, under3 = np.cross(m2, m4) @ m3, np.cross(m3, m4) @ m2
    diagonal = np.cross(m1, m4)
    over2, over3 = diagonal @ m3, diagonal @ m2
    if min(abs(under2), abs(under3), abs(over2), abs(over3)) < 1e-9:
        raise ValueError(f"three corners in line: {quad.tolist()}")
    n2 = over2 / under2 * m2 - m1
    n3 = over3 / under3 * m3 - m1
    from_photo = np.linalg.inv(matrix(focal, frame))
    return float(np.linalg.norm(from_photo @ n2) / np.linalg.norm(from_photo @ n3))
