"""Find where the parallel lines of a front meet in the photo: its vanishing points.

Intersections of strict lines are candidates; near doubles are taken out; all lines vote
by length, by how much of them lies in the front, and by alignment (section 3.3.2). A
vanishing point is a homogeneous row (x, y, w), and w = 0 is a point at infinity, so no
formula here divides by w.

Letters, as in the paper: `s` is a line, `omega` the share of it inside the mask,
`d(a, s)` Rother's distance of a vanishing point `a` from a line, `t_a` the distance at
which a line no longer counts.
"""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Homogeneous, Lines, Mask

ALIGNED_DEG = 2.0  # t_a
VERTICAL_DEG = 4.0  # lines nearer to the vertical point say nothing of the horizontal
MOST_OFF_DEG = 30.0  # of a candidate from a right angle to the vertical
OFF_SD_DEG = 15.0  # one standard deviation of the same
APART_DEG = 30.0  # t_o, which the paper leaves open


def lengths(lines: Lines) -> Float[np.ndarray, " n"]:
    """Measure lines in pixels."""
    return np.hypot(lines[:, 2] - lines[:, 0], lines[:, 3] - lines[:, 1])


def inside(lines: Lines, mask: Mask, *, samples: int = 9) -> Float[np.ndarray, " n"]:
    """Measure omega, the share of each line that lies inside a mask."""
    t = np.linspace(0, 1, samples)
    x = lines[:, :1] * (1 - t) + lines[:, 2:3] * t
    y = lines[:, 1:2] * (1 - t) + lines[:, 3:] * t
    h, w = mask.shape
    column = np.clip(np.rint(x), 0, w - 1).astype(np.intp)
    row = np.clip(np.rint(y), 0, h - 1).astype(np.intp)
    return mask[row, column].mean(axis=1)


def distance_deg(
    vanishing_points: Float[np.ndarray, "m 3"], lines: Lines
) -> Float[np.ndarray, "m n"]:
    """Measure Rother's distance of every vanishing point from every line, in degrees.

    It is the angle between the line and the ray from the line's middle to the point:
    for a = (x, y, w) and middle (u, v), the ray is (x - u w, y - v w), which is the
    point's own direction where w = 0 (Rother 2002, section 2.1; the paper's figure 3).
    """
    middle = (lines[:, :2] + lines[:, 2:]) / 2
    along = lines[:, 2:] - lines[:, :2]
    x, y, w = (vanishing_points[:, i, None] for i in range(3))
    ray_x, ray_y = x - middle[:, 0] * w, y - middle[:, 1] * w
    cross = np.abs(ray_x * along[:, 1] - ray_y * along[:, 0])
    dot = np.abs(ray_x * along[:, 0] + ray_y * along[:, 1])
    return np.degrees(np.arctan2(cross, dot))


def vote(
    vanishing_points: Float[np.ndarray, "m 3"],
    lines: Lines,
    weights: Float[np.ndarray, " n"],
    *,
    aligned_deg: float = ALIGNED_DEG,
) -> Float[np.ndarray, " m"]:
    """Weigh vanishing points by the share of evidence that each accounts for, 0 to 1.

    The weights are length times omega (section 3.3.2, equation 5). As printed, a line
    farther than t_a would vote against, by more the farther it is, so a front with much
    ornament would end with no candidate above zero: here such a line is silent.
    """
    total = weights.sum()
    if total <= 0:
        return np.zeros(len(vanishing_points))
    near = 1 - distance_deg(vanishing_points, lines) / aligned_deg
    return np.maximum(near, 0.0) @ weights / total


def intersections(lines: Lines) -> Float[np.ndarray, "m 3"]:
    """Intersect every pair of lines; parallel ones meet at infinity. Rows are units.

    Coordinates should be centred and of the order of one (`to_unit`), so that the
    length of a row means something.
    """
    n = len(lines)
    one = np.ones((n, 1))
    rows = np.cross(np.hstack([lines[:, :2], one]), np.hstack([lines[:, 2:], one]))
    i, j = np.triu_indices(n, 1)
    points = np.cross(rows[i], rows[j])
    norm = np.linalg.norm(points, axis=1)
    return points[norm > 1e-12] / norm[norm > 1e-12, None]


def without_collinear(
    lines: Lines, *, angle_deg: float = 0.5, offset: float = 0.002
) -> Float[np.ndarray, "_ 4"]:
    """Keep the longest of lines that lie on one another's continuation.

    Lines are quantised by direction and by distance from the image's origin seen along
    that direction; two on one continuation meet every third line at the same point.
    """
    along = lines[:, 2:] - lines[:, :2]
    angle = np.degrees(np.arctan2(along[:, 1], along[:, 0])) % 180
    cell = np.rint(angle / angle_deg)
    bin_angle = np.radians(cell * angle_deg)
    middle = (lines[:, :2] + lines[:, 2:]) / 2
    across = middle[:, 1] * np.cos(bin_angle) - middle[:, 0] * np.sin(bin_angle)
    order = np.argsort(-lengths(lines), kind="stable")
    keys = np.column_stack([cell % round(180 / angle_deg), np.rint(across / offset)])
    _, first = np.unique(keys[order], axis=0, return_index=True)
    return lines[np.sort(order[first])]


def without_doubles(
    points: Homogeneous, *, cell_deg: float = ALIGNED_DEG / 2
) -> Float[np.ndarray, "_ 3"]:
    """Keep one of the candidates that no vote could tell apart.

    On the unit sphere, cells of `cell_deg` are within the error bound t_a; points at
    and near infinity, which fill the sphere's equator, fall together there in the
    same way, opposite ends included.
    """
    sign = np.where(points[:, 2] < 0, -1.0, 1.0)
    flat = np.abs(points[:, 2]) < np.radians(cell_deg) / 2
    larger = np.abs(points[:, 0]) >= np.abs(points[:, 1])
    flip = np.where(np.where(larger, points[:, 0], points[:, 1]) < 0, -1.0, 1.0)
    points = points * np.where(flat, flip, sign)[:, None]
    points = np.where(flat[:, None], points * [1.0, 1.0, 0.0], points)
    cells = np.rint(points / np.radians(cell_deg)).astype(np.int64)
    _, first = np.unique(cells, axis=0, return_index=True)
    return points[np.sort(first)]


def to_unit(lines: Lines, centre: Float[np.ndarray, "2"], scale: float) -> Lines:
    """Shift and shrink coordinates, so that the focal length is about one."""
    return (lines - np.tile(centre, 2)) / scale


def grown(mask: Mask, by_px: int) -> Mask:
    """Grow a mask, so that the outline's own lines count as inside."""
    kernel = np.ones((2 * by_px + 1, 2 * by_px + 1), np.uint8)
    return cv2.dilate(mask.astype(np.uint8), kernel) > 0


def best_vertical(
    strict: Float[np.ndarray, "_ 4"],
    loose: Lines,
    weights: Float[np.ndarray, " n"],
    *,
    most: int = 120,
) -> tuple[Float[np.ndarray, "3"], float]:
    """Choose the vertical vanishing point of a photo, and the share of votes for it.

    Candidates are the intersections of the `most` longest steep strict lines within
    40 degrees of tilt and 12 of roll, beside the point at infinity of an upright
    camera. Lines and the answer are in units (`to_unit`); the point lies upwards.
    """
    steep = strict[np.abs(slopes_deg(strict) - 90) < 30]
    longest = np.argsort(-lengths(steep), kind="stable")[:most]
    points = intersections(without_collinear(steep[longest]))
    points = points * np.where(points[:, 1:2] > 0, -1.0, 1.0)
    roll = np.degrees(np.arctan2(points[:, 0], -points[:, 1]))
    tilt = np.degrees(np.arcsin(np.clip(points[:, 2], -1, 1)))
    points = points[(np.abs(roll) < 12) & (np.abs(tilt) < 40)]
    points = np.vstack([without_doubles(points), [[0.0, -1.0, 0.0]]])
    upwards = points * np.where(points[:, 1:2] > 0, -1.0, 1.0)
    votes = vote(upwards, loose, weights)
    return upwards[votes.argmax()], float(votes.max())


def horizontals(
    vertical: Float[np.ndarray, "3"],
    strict: Float[np.ndarray, "_ 4"],
    loose: Lines,
    weights: Float[np.ndarray, " n"],
    *,
    most: int = 100,
) -> tuple[Float[np.ndarray, "m 3"], Float[np.ndarray, " m"]]:
    """List candidates for a front's horizontal vanishing point, with their votes.

    Lines that could be vertical are left out. Candidates are the intersections of the
    `most` longest strict lines (of the loose ones where fewer than six are left), and
    each loose line's intersection with the horizon that the vertical point and the
    prior's focal length imply. A candidate's votes count less the farther it is from a
    right angle to the vertical, which is itself uncertain, as is the focal length.
    """
    strict = strict[distance_deg(vertical[None], strict)[0] > VERTICAL_DEG]
    away = distance_deg(vertical[None], loose)[0] > VERTICAL_DEG
    loose, weights = loose[away], weights[away]
    if len(loose) < 2:
        return np.empty((0, 3)), np.empty(0)
    if len(strict) < 6:
        strict = loose
    longest = np.argsort(-lengths(strict), kind="stable")[:most]
    points = intersections(without_collinear(strict[longest]))
    points = points[np.abs(points @ vertical) < np.sin(np.radians(MOST_OFF_DEG))]
    one = np.ones((len(loose), 1))
    rows = np.cross(np.hstack([loose[:, :2], one]), np.hstack([loose[:, 2:], one]))
    level = np.cross(rows, vertical)
    norm = np.linalg.norm(level, axis=1)
    level = level[norm > 1e-9] / norm[norm > 1e-9, None]
    points = without_doubles(np.vstack([points, level]))
    off = np.degrees(np.arcsin(np.clip(points @ vertical, -1, 1)))
    votes = vote(points, loose, weights) * np.exp(-0.5 * (off / OFF_SD_DEG) ** 2)
    return points, votes


def best_horizontal(
    vertical: Float[np.ndarray, "3"],
    strict: Float[np.ndarray, "_ 4"],
    loose: Lines,
    weights: Float[np.ndarray, " n"],
) -> tuple[Float[np.ndarray, "3"], float] | None:
    """Choose the horizontal vanishing point with most votes, and their share."""
    points, votes = horizontals(vertical, strict, loose, weights)
    if not len(points):
        return None
    return points[votes.argmax()], float(votes.max())


def agreed_up(
    vertical: Float[np.ndarray, "3"],
    vertical_weight: float,
    across: Float[np.ndarray, "m 3"],
    weights: Float[np.ndarray, " m"],
) -> Float[np.ndarray, "3"]:
    """Find the way up that suits the vertical point and all horizontals best.

    It is the unit u that minimises w_v |u - v (u . v)|^2 + sum w_i (u . h_i)^2, so the
    least eigenvector of a 3x3 matrix. Scratches along the film can outvote walls as
    the vertical; horizontals that meet elsewhere than on its horizon then correct it.
    """
    matrix = vertical_weight * (np.eye(3) - np.outer(vertical, vertical))
    matrix = matrix + (across * weights[:, None]).T @ across
    return np.linalg.eigh(matrix)[1][:, 0]


def spread_out(
    points: Float[np.ndarray, "m 3"],
    votes: Float[np.ndarray, " m"],
    *,
    most: int,
    apart_deg: float = APART_DEG,
) -> Float[np.ndarray, "_ 3"]:
    """Take candidates by falling votes, none within t_o of one already taken."""
    taken: list[np.ndarray] = []
    least = np.cos(np.radians(apart_deg))
    for i in np.argsort(-votes, kind="stable"):
        if all(abs(points[i] @ other) < least for other in taken):
            taken.append(points[i])
        if len(taken) == most:
            break
    return np.array(taken).reshape(-1, 3)


def slopes_deg(lines: Lines) -> Float[np.ndarray, " n"]:
    """Measure the lines' directions in the image, modulo 180 degrees; 90 is steep."""
    along = lines[:, 2:] - lines[:, :2]
    return np.degrees(np.arctan2(along[:, 1], along[:, 0])) % 180
