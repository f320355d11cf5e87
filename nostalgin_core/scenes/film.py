"""From light to a scanned negative: tone, softness, grain, scratches, border, punch."""

import cv2
import numpy as np
from jaxtyping import Float

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.records import Box
from nostalgin_core.scenes import grain

Plane = Float[np.ndarray, "h w"]


def exposed(rng: np.random.Generator, shape: tuple[int, int]) -> tuple[Box, Plane]:
    """Lay the film's black border: the exposed frame, and how far each pixel is in it.

    The corners are rounded and the edge is a little rough.
    """
    h, w = shape
    unit = w / 560
    left, right = np.round(rng.uniform(3, 9, 2) * unit).astype(int)
    top, low = np.round(rng.uniform([7, 4], [13, 11]) * unit).astype(int)
    box = Box(int(left), int(top), int(w - right), int(h - low))
    round_px = int(rng.uniform(4, 8) * unit)
    sheet = np.zeros(shape, np.uint8)
    inner = (box.x0 + round_px, box.y0 + round_px)
    outer = (box.x1 - 1 - round_px, box.y1 - 1 - round_px)
    cv2.rectangle(sheet, inner, outer, 255, -1)
    disc = cv2.getStructuringElement(
        cv2.MORPH_ELLIPSE, (2 * round_px + 1, 2 * round_px + 1)
    )
    sheet = cv2.dilate(sheet, disc)
    inside = cv2.GaussianBlur(sheet, (0, 0), 0.8 * unit).astype(np.float32) / 255
    return box, inside


def develop(rng: np.random.Generator, light: Plane, inside: Plane) -> Gray:
    """Turn the camera's picture (0 to 255) into a scanned negative."""
    h, w = light.shape
    unit = w / 560
    glow = cv2.GaussianBlur(np.maximum(light - 170, 0), (0, 0), 7 * unit)
    veil = rng.uniform(2, 14)
    tone = veil + (1 - veil / 255) * light + 0.12 * glow
    y, x = np.mgrid[-1 : 1 : h * 1j, -1 : 1 : w * 1j].astype(np.float32)
    tone *= 1.0 - rng.uniform(0.05, 0.14) * (x * x + y * y)
    gain = rng.uniform(0.9, 1.06)
    # A negative's curve: a soft toe, and a long shoulder where the sky lies.
    density = (1.9 * np.clip(gain * tone / 255, 0.0, 1.3)) ** 1.8
    tone = 12 + 226 * (1 - np.exp(-density))
    # The developer sharpens edges, for it is used up beside dense places.
    tone = tone + 0.45 * (tone - cv2.GaussianBlur(tone, (0, 0), 1.4 * unit))
    tone = age(rng, tone)
    tone = tone + graininess(
        rng, (h, w), tone, strength=float(np.clip(rng.lognormal(0.55, 0.5), 0.7, 3.2))
    )
    border = rng.uniform(8, 22) + 1.2 * rng.standard_normal((h, w), np.float32)
    tone = inside * tone + (1 - inside) * border
    return np.clip(np.round(tone), 0, 255).astype(np.uint8)


def graininess(
    rng: np.random.Generator, shape: tuple[int, int], tone: Plane, *, strength: float
) -> Plane:
    """Make film grain: clumped noise, strongest in the middle tones."""
    noise = rng.standard_normal(shape, dtype=np.float32)
    clumped = cv2.GaussianBlur(noise, (0, 0), 0.8)
    clumped /= clumped.std()
    share = tone / 255
    return strength * clumped * (0.3 + 2.8 * share * (1 - share))


def age(rng: np.random.Generator, tone: Plane) -> Plane:
    """Scratch and spot the negative, lightly."""
    h, w = tone.shape
    marks = np.zeros((h, w), np.float32)
    if rng.random() < 0.35:
        for _ in range(int(rng.integers(1, 14))):
            x = rng.uniform(0, w)
            ends = [
                (x, rng.uniform(-h, h)),
                (x + rng.normal(0, 3), rng.uniform(0, 2 * h)),
            ]
            fixed = [
                tuple(np.round(np.array(p) * 16).astype(int).tolist()) for p in ends
            ]
            shade = float(rng.choice([-1, 1]) * rng.uniform(8, 26))
            cv2.line(marks, fixed[0], fixed[1], shade, 1, cv2.LINE_AA, 4)
    for _ in range(int(rng.poisson(8))):
        at = (int(rng.integers(w)), int(rng.integers(h)))
        size = int(rng.choice([1, 1, 1, 2, 3]) * max(1, w // 560))
        cv2.circle(marks, at, size, float(rng.choice([-60, 45])), -1, cv2.LINE_AA)
    if rng.random() < 0.08:
        for _ in range(int(rng.integers(8, 40))):
            at = (int(rng.integers(w)), int(rng.integers(h // 2)))
            cv2.circle(marks, at, 4 * max(1, w // 560), 45.0, -1, cv2.LINE_AA)
            cv2.circle(marks, at, max(1, w // 560), -80.0, -1, cv2.LINE_AA)
    if rng.random() < 0.3:
        curl = np.cumsum(rng.normal(0, 1, (40, 2)), axis=0).cumsum(axis=0) * 0.25
        points = np.round(curl + rng.uniform([0, 0], [w, h])).astype(np.int32)
        cv2.polylines(
            marks, [points], isClosed=False, color=-70.0, lineType=cv2.LINE_AA
        )
    return tone + cv2.GaussianBlur(marks, (0, 0), 0.5)


def punch(rng: np.random.Generator, shape: tuple[int, int]) -> Plane:
    """Give the disc that the archive's punch took out of the film, 0 to 1."""
    h, w = shape
    disc = np.zeros(shape, np.uint8)
    radius = rng.uniform(0.042, 0.052) * w
    at = (rng.uniform(0.1, 0.9) * w, rng.uniform(0.84, 0.95) * h)
    fixed = tuple(np.round(np.array(at) * 16).astype(int).tolist())
    cv2.circle(disc, fixed, round(radius * 16), 255, -1, cv2.LINE_AA, 4)
    return disc.astype(np.float32) / 255


def fog(rng: np.random.Generator, shape: tuple[int, int]) -> Plane:
    """Spoil a film: light from a leaking holder, and nothing else."""
    h, w = shape
    small = grain.cloud(rng, (h // 16, w // 16), scale_px=w / 40)
    soft = cv2.resize(small, (w, h), interpolation=cv2.INTER_CUBIC)
    left, right = rng.uniform(150, 245, 2)
    slope = np.linspace(left, right, w, dtype=np.float32)[None, :]
    return np.clip(slope + 14 * soft, 0, 255)


def clip_to_frame(mask: Mask, inside: Plane) -> Mask:
    """Keep what lies on exposed film."""
    return mask & (inside > 0.5)
