"""Who and what is in the street on the day: cars at the kerb, passers-by, lamps."""

import numpy as np

from nostalgin_core.scenes import cars, lens, people, props
from nostalgin_core.scenes.ground import PAVEMENT_M
from nostalgin_core.scenes.lens import Camera
from nostalgin_core.scenes.lot import OUTWARD, Lot
from nostalgin_core.scenes.sprite import Sprite
from nostalgin_core.scenes.street import PaintedBlock

REACH_M = 75.0


def kerbs(
    blocks: list[PaintedBlock],
) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, float]]:
    """List the sides of all blocks: left end, direction, outward, length."""
    found = []
    for block in blocks:
        west, south, east, north = block.corner_m
        ends = np.array([[west, south], [east, south], [east, north], [west, north]])
        for side in range(4):
            span = ends[(side + 1) % 4] - ends[side]
            long = float(np.linalg.norm(span))
            found.append((ends[side], span / long, np.array(OUTWARD[side]), long))
    return found


def inview(camera: Camera, place_m: np.ndarray, shape: tuple[int, int]) -> bool:
    """Say whether a place on the ground is before the camera, about in the frame."""
    seen = lens.see(camera, np.array([[*place_m, 0.0]]))[0]
    if not 2.0 < seen[2] < REACH_M:
        return False
    x = camera.focal_px * seen[0] / seen[2] + camera.principal_px[0]
    return bool(-0.4 * shape[1] < x < 1.4 * shape[1])


def populate(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    blocks: list[PaintedBlock],
) -> list[Sprite]:
    """Fill the street: each kerb in view gets cars, people, lamps and the odd tree."""
    found: list[Sprite | None] = []
    busy = rng.uniform(0.2, 0.85)
    crowded = rng.uniform(0.02, 0.16)
    for start, along, out, long in kerbs(blocks):
        heading = float(np.rad2deg(np.arctan2(along[1], along[0])))
        at = rng.uniform(2.0, 6.0)
        while at < long - 4.0:
            middle = start + along * at + out * (PAVEMENT_M + rng.uniform(1.1, 1.4))
            free = far(camera, middle, 6.5) and inview(camera, middle, shape)
            if rng.random() < busy and free:
                turn = heading + 180.0 * (rng.random() < 0.3)
                found.extend(
                    cars.park(rng, camera, shape, (middle[0], middle[1]), turn)
                )
            at += rng.uniform(5.4, 7.5)
        found.extend(traffic(rng, camera, shape, (start, along, out, long)))
        for step in np.arange(0.5, long, 0.5):
            if rng.random() < crowded:
                feet = start + along * step + out * rng.uniform(0.6, PAVEMENT_M - 0.4)
                if inview(camera, feet, shape) and far(camera, feet, 4.5):
                    found.append(people.stand(rng, camera, shape, (feet[0], feet[1])))
        found.extend(furniture(rng, camera, shape, (start, along, out, long)))
    return [sprite for sprite in found if sprite]


def traffic(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    kerb: tuple[np.ndarray, np.ndarray, np.ndarray, float],
) -> list[Sprite]:
    """Let a car or two drive by, at least eight metres before the camera."""
    start, along, out, long = kerb
    found: list[Sprite] = []
    heading = float(np.rad2deg(np.arctan2(along[1], along[0])))
    for _ in range(int(rng.poisson(0.25))):
        at = rng.uniform(0.0, long)
        place = start + along * at + out * (PAVEMENT_M + rng.uniform(3.8, 4.8))
        if inview(camera, place, shape) and far(camera, place, 8.0):
            found.extend(cars.park(rng, camera, shape, (place[0], place[1]), heading))
    return found


def far(camera: Camera, place_m: np.ndarray, least_m: float) -> bool:
    """Say whether a place is at least this far from the camera."""
    return float(np.linalg.norm(camera.eye_m[:2] - place_m)) > least_m


def furniture(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    kerb: tuple[np.ndarray, np.ndarray, np.ndarray, float],
) -> list[Sprite | None]:
    """Stand lamps, hydrants and trees along a kerb."""
    start, along, out, long = kerb
    found: list[Sprite | None] = []
    lamps = np.arange(rng.uniform(3, 40), long, 34.0)
    posts = rng.uniform(0.0, long, 2)
    trees = rng.uniform(0.0, long, int(rng.random() < 0.12))
    for places, stand in (
        (lamps, props.lamp_post),
        (posts, props.hydrant),
        (trees, props.tree),
    ):
        for at in places:
            feet = start + along * at + out * (PAVEMENT_M - 0.45)
            if inview(camera, feet, shape) and far(camera, feet, 5.0):
                found.append(stand(rng, camera, shape, (feet[0], feet[1])))
    return found


def fittings(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    lots: list[Lot],
) -> list[Sprite]:
    """Hang signs and awnings on the shops in view."""
    found: list[Sprite | None] = []
    for lot in lots:
        for wall in lot.walls:
            if wall.front is None or wall.style is None or not wall.style.shops:
                continue
            start, end = np.array([*wall.start_m, 0.0]), np.array([*wall.end_m, 0.0])
            out = np.array([*OUTWARD[wall.front.side], 0.0])
            middle = (start + end) / 2
            seen = lens.see(camera, middle[None])[0, 2]
            facing = out @ (camera.eye_m - middle)
            if facing < 0 or not 2.0 < seen < REACH_M:
                continue
            if rng.random() < 0.4:
                share = rng.uniform(0.1, 0.9)
                foot = start + share * (end - start)
                foot[2] = rng.uniform(3.4, 5.5)
                found.append(props.hanging_sign(rng, camera, shape, foot, out))
            if rng.random() < 0.35:
                cut = np.sort(rng.uniform(0.05, 0.95, 2))
                left, right = (start + share * (end - start) for share in cut)
                if np.linalg.norm(right - left) > 1.5:
                    found.append(props.awning(rng, camera, shape, left, right, out=out))
    return [sprite for sprite in found if sprite]


def surveyors(
    rng: np.random.Generator,
    camera: Camera,
    shape: tuple[int, int],
    *,
    text: str,
    towards_px: float,
) -> list[Sprite]:
    """Stand the number board before the camera, and often the assistant beside it."""
    look = camera.rotation[2] * [1.0, 1.0, 0.0]
    look /= np.linalg.norm(look)
    right = np.cross(look, [0.0, 0.0, 1.0])
    depth = float(rng.uniform(2.4, 5.2))
    # The horizon lies where the tilt puts it; the board stands a little below it.
    aside = float(rng.uniform(-0.22, 0.22)) * depth
    place = camera.eye_m + depth * look + aside * right
    place[2] = rng.uniform(0.95, 1.25)
    pixel = lens.project(camera, place[None])[0]
    arrow = float(np.clip((towards_px - pixel[0]) / (0.3 * shape[1]), -1.0, 1.0))
    found: list[Sprite] = props.number_board(
        camera,
        shape,
        place,
        text=text,
        arrow=arrow,
        roll_deg=float(rng.normal(0.0, 1.6)),
    )
    if rng.random() < 0.45:
        side = float(rng.choice([-1.0, 1.0]))
        feet = place + 1.15 * side * right + 0.25 * look
        person = people.stand(
            rng, camera, shape, (float(feet[0]), float(feet[1])), pointing=-side
        )
        found.extend([person] if person else [])
    return found
