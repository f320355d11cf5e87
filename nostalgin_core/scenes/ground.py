"""Pavement, kerb and roadway, and the sky above them."""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.scenes import grain
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.surface import NOBODY, Canvas

PAVEMENT_M = 4.0
KERB_M = 0.18
Plane = Float[np.ndarray, "h w"]
Box = tuple[float, float, float, float]


def lay(
    rng: np.random.Generator, canvas: Canvas, camera: Camera, blocks: list[Box]
) -> None:
    """Draw the ground wherever a ray meets it and no wall is nearer.

    For a pixel's ray d = R^T K^-1 (x, y, 1) from the eye e, the ground is met where
    e_z + s d_z = 0, and s is the depth.
    """
    h, w = canvas.tone.shape
    rays = camera.rotation.T @ np.linalg.inv(camera.matrix)
    x = np.arange(w, dtype=np.float64)[None, :]
    y = np.arange(h, dtype=np.float64)[:, None]
    eye = camera.eye_m
    near = (-(rays[2, 0] * x + rays[2, 1] * y + rays[2, 2]) / eye[2]).astype(np.float32)
    mine = (near > 1 / 400.0) & (near > canvas.nearness)
    rows, columns = np.nonzero(mine)
    if len(rows) == 0:
        return
    depth = 1.0 / near[mine].astype(np.float64)
    east = eye[0] + depth * (rays[0, 0] * columns + rays[0, 1] * rows + rays[0, 2])
    north = eye[1] + depth * (rays[1, 0] * columns + rays[1, 1] * rows + rays[1, 2])
    nearby = [
        box
        for box in blocks
        if max(box[0] - eye[0], eye[0] - box[2], box[1] - eye[1], eye[1] - box[3]) < 90
    ]
    places = (np.float32(east), np.float32(north), np.float32(depth))
    canvas.tone[mine] = surface(rng, *places, nearby)
    canvas.nearness[mine] = near[mine]
    canvas.label[mine] = NOBODY


def surface(
    rng: np.random.Generator,
    east_m: np.ndarray,
    north_m: np.ndarray,
    depth_m: np.ndarray,
    blocks: list[Box],
) -> np.ndarray:
    """Say how light the ground is at each place."""
    away = np.full(east_m.shape, np.inf, np.float32)
    for west, south, east, north in blocks:
        dx = np.maximum(west - east_m, east_m - east)
        dy = np.maximum(south - north_m, north_m - north)
        away = np.minimum(away, np.maximum(dx, dy).astype(np.float32))
    fine = np.clip(1.3 - depth_m / 18.0, 0.1, 1.0).astype(np.float32)
    rough = tile(rng, east_m, north_m, step_m=0.02) * fine
    patches = tile(rng, east_m, north_m, step_m=0.25)
    tracks = tile(rng, 0.06 * east_m, north_m, step_m=0.1)
    tracks += tile(rng, east_m, 0.06 * north_m, step_m=0.1)
    road = float(rng.uniform(88, 128)) + 5 * patches + 4 * tracks + 4 * rough
    stone = float(rng.uniform(140, 170)) + 5 * patches + 4 * rough
    flag = float(rng.choice([1.2, 1.5, 1.8]))
    for along in (east_m, north_m):
        gap = np.abs((along / flag) % 1.0 - 0.5)
        width = 0.012 + 0.0006 * depth_m
        stone = stone - 34 * fine * (gap > 0.5 - width)
    tone = np.where(away < PAVEMENT_M, stone, road)
    kerb = (away >= PAVEMENT_M) & (away < PAVEMENT_M + KERB_M)
    tone = np.where(kerb, 162 + 4 * rough, tone)
    gutter = np.clip((away - PAVEMENT_M - KERB_M) / 0.8, 0, 1)
    tone = np.where(away >= PAVEMENT_M + KERB_M, tone * (0.72 + 0.28 * gutter), tone)
    covers = np.hypot((east_m % 17.0) - 8.5, (north_m % 13.0) - 6.5)
    lid = (covers < 0.38) & (away > PAVEMENT_M + 1.0)
    tone = np.where(lid, tone * (0.62 + 0.2 * ((covers * 14) % 1 > 0.5)), tone)
    return tone.astype(np.float32)


def tile(
    rng: np.random.Generator, x_m: np.ndarray, y_m: np.ndarray, *, step_m: float
) -> np.ndarray:
    """Look noise up in a tile that repeats every 512 steps."""
    size = 512
    sheet = rng.standard_normal((size, size), dtype=np.float32)
    sheet = cv2.GaussianBlur(sheet, (0, 0), 1.0, borderType=cv2.BORDER_REFLECT)
    sheet /= sheet.std()
    rows = (y_m * np.float32(1 / step_m)).astype(np.int32) & (size - 1)
    columns = (x_m * np.float32(1 / step_m)).astype(np.int32) & (size - 1)
    return sheet.ravel()[rows * size + columns]


def sky(rng: np.random.Generator, canvas: Canvas) -> None:
    """Fill the rest with an overexposed sky, brighter towards the horizon."""
    h, w = canvas.tone.shape
    top, low = rng.uniform(188, 214), rng.uniform(218, 238)
    ramp = np.linspace(top, low, h, dtype=np.float32)[:, None]
    clouds = grain.cloud(rng, (h // 8, w // 8), scale_px=w / 24)
    soft = cv2.resize(clouds, (w, h), interpolation=cv2.INTER_LINEAR)
    empty = canvas.nearness == 0
    canvas.tone[empty] = (ramp + 2.5 * soft)[empty]
