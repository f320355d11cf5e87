"""Where the photographer stands: across the street, at eye height, a little aside."""

import numpy as np

from nostalgin_core.scenes import lens
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.lot import OUTWARD, Lot, Wall
from nostalgin_core.scenes.street import AVENUE_M, STREET_M

EYE_M = 1.55
FOCAL_WIDTHS = 1.2  # focal length of the tax photos, in picture widths (median of 98)
TILTS_DEG = (2.0, 5.0, 8.0, 11.0, 14.0, 17.0)
TRIES = 48


def choose(
    rng: np.random.Generator,
    lot: Lot,
    blocks: list[tuple[float, float, float, float]],
    *,
    shape: tuple[int, int],
) -> Camera:
    """Pick the best of some places: the whole front in the frame, seen a little aside.

    Each place is scored by how far the fronts' corners fall outside the frame and how
    far the view is from a photographer's usual slant.
    """
    fronts = [wall for wall in lot.walls if wall.front]
    focal = FOCAL_WIDTHS * shape[1] * rng.uniform(0.9, 1.12)
    if shape[1] > shape[0]:
        focal *= shape[0] / shape[1]
    best: tuple[float, Camera] | None = None
    for _ in range(TRIES):
        eye, yaw = spot(rng, fronts)
        if inside_any(eye, blocks):
            continue
        roll = float(rng.normal(0.0, 0.5))
        for tilt in TILTS_DEG:
            camera = lens.aim(
                eye,
                yaw_deg=yaw,
                tilt_deg=tilt + float(rng.uniform(-1.4, 1.4)),
                roll_deg=roll,
                focal_px=float(focal),
                principal_px=((shape[1] - 1) / 2, (shape[0] - 1) / 2),
            )
            cost = misfit(camera, fronts, shape) + rng.uniform(0.0, 25.0)
            if best is None or cost < best[0]:
                best = (cost, camera)
    if best is None:
        msg = f"no free place before lot {lot.block}-{lot.lot}"
        raise ValueError(msg)
    return best[1]


def spot(rng: np.random.Generator, fronts: list[Wall]) -> tuple[np.ndarray, float]:
    """Propose a place and a heading: opposite a front, or across from a corner."""
    ends = np.array([[wall.start_m, wall.end_m] for wall in fronts])
    sides = [wall.front.side for wall in fronts if wall.front]
    outs = np.array([OUTWARD[side] for side in sides])
    wides = [STREET_M if side % 2 == 0 else AVENUE_M for side in sides]
    if len(fronts) == 2:
        middle = ends[0, 1]
        away = sum(
            out * wide * rng.uniform(0.5, 1.0)
            for out, wide in zip(outs, wides, strict=True)
        )
        eye = middle + away + rng.normal(0.0, 2.0, 2)
        target = middle
    else:
        target = ends[0].mean(axis=0)
        along = np.array([-outs[0][1], outs[0][0]])
        aside = rng.uniform(-1.25, 1.25) * wides[0]
        eye = target + outs[0] * (wides[0] - rng.uniform(0.8, 3.8)) + along * aside
    look = target - eye
    yaw = np.rad2deg(np.arctan2(-look[0], look[1])) + rng.normal(0.0, 4.0)
    return np.array([*eye, EYE_M + rng.normal(0.0, 0.05)]), float(yaw)


def inside_any(
    eye_m: np.ndarray, blocks: list[tuple[float, float, float, float]]
) -> bool:
    """Say whether a place is inside a building, or with its back to a wall."""
    return any(
        west - 0.4 < eye_m[0] < east + 0.4 and south - 0.4 < eye_m[1] < north + 0.4
        for west, south, east, north in blocks
    )


def misfit(camera: Camera, fronts: list[Wall], shape: tuple[int, int]) -> float:
    """Weigh what spoils a view, in pixels."""
    cost = 0.0
    margin = 0.03 * shape[1]
    for wall in fronts:
        corners = corners_m(wall)
        seen = lens.see(camera, corners)
        if seen[:, 2].min() < 1.0:
            return 1e6
        pixels = lens.project(camera, corners)
        over = np.maximum(margin - pixels, pixels + margin - [shape[1], shape[0]])
        over = np.maximum(over, 0.0)
        cost += over[:, 0].max() + 1.2 * over[:, 1].max()
        across = pixels[2:, 0].max() - pixels[2:, 0].min()
        cost += max(0.0, 0.16 * shape[1] - across)
        tall = pixels[:, 1].max() - pixels[:, 1].min()
        cost += 0.25 * max(0.0, 0.5 * shape[0] - tall)
        cost += 6.0 * slant_excess(camera, wall, corner=len(fronts) == 2)
    return cost


def slant_excess(camera: Camera, wall: Wall, *, corner: bool) -> float:
    """Say by how many degrees a view is too frontal or too slanted."""
    assert wall.front is not None
    out = np.array([*OUTWARD[wall.front.side], 0.0])
    look = camera.eye_m - corners_m(wall).mean(axis=0)
    look[2] = 0.0
    slant = np.rad2deg(np.arccos(look @ out / np.linalg.norm(look)))
    least, most = (25.0, 65.0) if corner else (9.0, 42.0)
    return float(max(0.0, least - slant, slant - most))


def corners_m(wall: Wall) -> np.ndarray:
    """Give a wall's corners in the world: tl, tr, br, bl seen from outside."""
    low, high = (0.0,), (wall.height_m,)
    return np.array(
        [
            wall.start_m + high,
            wall.end_m + high,
            wall.end_m + low,
            wall.start_m + low,
        ]
    )
