"""Pavement, kerb and roadway, and the sky above them."""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.scenes import grain
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.surface import NOBODY, Canvas

PAVEMENT_M = 4.0
KERB_M = 0.18
Row = Float[np.ndarray, " n"]
ROOF_M = 16.0  # how high the houses are that shade the ground
Box = tuple[float, float, float, float]


def lay(
    rng: np.random.Generator,
    canvas: Canvas,
    camera: Camera,
    blocks: list[Box],
    *,
    sun: tuple[float, float, float],
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
    places = tuple(row.astype(np.float32) for row in (east, north, depth))
    tone = surface(rng, places[0], places[1], places[2], nearby)
    canvas.tone[mine] = tone * shade(places[0], places[1], nearby, sun=sun)
    canvas.nearness[mine] = near[mine]
    canvas.label[mine] = NOBODY


def shade(
    east_m: Row, north_m: Row, blocks: list[Box], *, sun: tuple[float, float, float]
) -> Row:
    """Say how much light reaches the ground past the houses, all of one height.

    The ray to the sun passes below the roofs for a while; where it is over a block
    during that time, the ground lies in the block's shadow.
    """
    reach = ROOF_M / sun[2]
    dark = np.zeros(east_m.shape, np.float32)
    for share in (0.15, 0.4, 0.7, 1.0):
        x, y = east_m + share * reach * sun[0], north_m + share * reach * sun[1]
        for west, south, east, north in blocks:
            inside = np.minimum(
                np.minimum(x - west, east - x), np.minimum(y - south, north - y)
            )
            np.maximum(dark, inside, out=dark)
    return 1.0 - 0.34 * np.clip(dark / 0.35, 0.0, 1.0)


def surface(
    rng: np.random.Generator,
    east_m: Row,
    north_m: Row,
    depth_m: Row,
    blocks: list[Box],
) -> Row:
    """Say how light the ground is at each place."""
    away = np.full(east_m.shape, np.inf, np.float32)
    for west, south, east, north in blocks:
        dx = np.maximum(west - east_m, east_m - east)
        dy = np.maximum(south - north_m, north_m - north)
        np.minimum(away, np.maximum(dx, dy), out=away)
    fine = np.clip(1.3 - depth_m / 14.0, 0.0, 1.0).astype(np.float32)
    rough = tile(rng, east_m, north_m, step_m=0.012) * fine
    patches = tile(rng, east_m, north_m, step_m=0.45)
    road = asphalt(rng, east_m, north_m) + 2.5 * patches + 2.5 * rough
    stone = flags(rng, east_m, north_m, depth_m, fine) + 2.5 * patches + 2.5 * rough
    tone = np.where(away < PAVEMENT_M, stone, road)
    kerb = (away >= PAVEMENT_M) & (away < PAVEMENT_M + KERB_M)
    tone = np.where(kerb, 190 + 4 * rough, tone)
    gutter = np.clip((away - PAVEMENT_M - KERB_M) / 0.8, 0, 1)
    tone = np.where(away >= PAVEMENT_M + KERB_M, tone * (0.7 + 0.3 * gutter), tone)
    lid = np.hypot((east_m % 17.0) - 8.5, (north_m % 13.0) - 6.5)
    iron = (lid < 0.4) & (away > PAVEMENT_M + 1.0)
    ring = 0.55 + 0.3 * ((lid * 11) % 1 > 0.5)
    return np.where(iron, tone * ring, tone).astype(np.float32)


def asphalt(rng: np.random.Generator, east_m: Row, north_m: Row) -> Row:
    """Give the roadway's tone: worn lanes, mended patches, now and then a seam."""
    tone = np.full(east_m.shape, rng.uniform(112, 168), np.float32)
    wide, high = rng.uniform(2.0, 4.5, 2)
    column = (east_m / np.float32(wide)).astype(np.int32) & 63
    row = (north_m / np.float32(high)).astype(np.int32) & 63
    mended = rng.normal(0, 9, (64, 64)).astype(np.float32)
    mended[rng.random((64, 64)) > 0.16] = 0.0
    tone += mended[row, column]
    for _ in range(3):
        slope, at = rng.normal(0, 1.2), rng.uniform(-30, 30)
        bend = 0.25 * tile(rng, east_m, north_m * 0, step_m=0.9)
        line = np.abs(((north_m - slope * east_m - at + bend) % 23.0) - 11.5)
        tone -= 22 * np.clip(1 - line / 0.04, 0, 1)
    return tone + 4 * tile(rng, 0.05 * east_m, 0.05 * north_m, step_m=0.06)


def flags(
    rng: np.random.Generator, east_m: Row, north_m: Row, depth_m: Row, fine: Row
) -> Row:
    """Give the pavement's tone: flagstones and their joints."""
    size = float(rng.choice([1.2, 1.5, 1.8]))
    tone = np.full(east_m.shape, rng.uniform(158, 196), np.float32)
    each = rng.normal(0, 5, (64, 64)).astype(np.float32)
    column = (east_m / np.float32(size)).astype(np.int32) & 63
    tone += each[(north_m / np.float32(size)).astype(np.int32) & 63, column]
    for along in (east_m, north_m):
        gap = np.abs((along / np.float32(size)) % 1.0 - 0.5)
        tone -= 38 * fine * (gap > 0.5 - 0.01 - 0.0006 * depth_m)
    return tone


def tile(rng: np.random.Generator, x_m: Row, y_m: Row, *, step_m: float) -> Row:
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
    top, low = rng.uniform(196, 232), rng.uniform(226, 250)
    ramp = np.linspace(top, low, h, dtype=np.float32)[:, None]
    clouds = grain.cloud(rng, (h // 8, w // 8), scale_px=w / 24)
    soft = cv2.resize(clouds, (w, h), interpolation=cv2.INTER_LINEAR)
    empty = canvas.nearness == 0
    canvas.tone[empty] = (ramp + 2.5 * soft)[empty]
