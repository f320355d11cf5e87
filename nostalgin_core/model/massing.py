"""Plain gray volumes of many buildings in one small GLB: a city from far away.

A prism stands on a convex outline. Nothing of it is a photograph, and the file says so.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Float, UInt32

from nostalgin_core import evidence
from nostalgin_core.model.atlas import TONES
from nostalgin_core.model.buffer import (
    ELEMENT_ARRAY_BUFFER,
    Buffer,
    Json,
    accessor,
    container,
    vertices,
)
from nostalgin_core.model.mesh import LIGHT

ROOF: Final = TONES[0]

Outlines3 = Float[np.ndarray, "p n 3"]
Faces = Float[np.ndarray, "_ _ 3"]  # of several sizes


@dataclass(frozen=True, slots=True, eq=False)
class Volumes:
    """Prisms between two convex outlines each, anticlockwise, all of n corners."""

    low_m: Outlines3  # east, north, up
    high_m: Outlines3


def massing(
    volumes: Sequence[Volumes], *, extras: dict[str, Any] | None = None
) -> bytes:
    """Write prisms without their floors as one mesh of flat grays.

    Raises:
        ValueError: if there is none.
    """
    if not volumes:
        raise ValueError("a massing needs a volume")
    faces = [face for one in volumes for face in (_walls(one), one.high_m)]
    tones = np.concatenate([np.repeat(_tones(one), one.shape[1]) for one in faces])
    points = np.concatenate([one.reshape(-1, 3) for one in faces])
    east, north, up = points.T
    buffer = Buffer()
    attributes = {
        "POSITION": vertices(
            buffer, np.column_stack([east, up, -north]), "VEC3", bounds=True
        ),
        # glTF's vertex colours are linear, and the grays are as a screen shows them
        "COLOR_0": vertices(
            buffer, np.repeat(_linear(tones)[:, None], 3, axis=1), "VEC3"
        ),
    }
    indices = accessor(
        buffer, _fans(faces).ravel(), "SCALAR", target=ELEMENT_ARRAY_BUFFER
    )
    primitive = {
        "attributes": attributes,
        "indices": indices,
        "material": 0,
        "mode": 4,
    }
    return container(_document(buffer, primitive, extras or {}), bytes(buffer.data))


def _document(buffer: Buffer, primitive: Json, extras: dict[str, Any]) -> Json:
    told = {"evidence": evidence.NAMES[evidence.ASSUMED], **extras}
    return {
        "asset": {"version": "2.0", "generator": "nostalgin", "extras": told},
        "extensionsUsed": ["KHR_materials_unlit"],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "massing", "mesh": 0}],
        "meshes": [{"primitives": [primitive]}],
        "materials": [
            {
                "name": "plain",
                "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 1.0},
                "extensions": {"KHR_materials_unlit": {}},
            }
        ],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
    }


def _walls(one: Volumes) -> Faces:
    """Stand walls on all edges: lower left, lower right, upper right, upper left."""
    low, high = one.low_m, one.high_m
    ahead = (np.roll(low, -1, axis=1), np.roll(high, -1, axis=1))
    return np.stack([low, *ahead, high], axis=2).reshape(-1, 4, 3)


def _fans(faces: Sequence[Faces]) -> UInt32[np.ndarray, "t 3"]:
    """Cut convex faces into triangles round their first corners."""
    start, fans = 0, []
    for one in faces:
        count, corners = one.shape[:2]
        firsts = start + corners * np.arange(count)[:, None, None]
        fan = [[0, n, n + 1] for n in range(1, corners - 1)]
        fans.append((firsts + np.array(fan)).reshape(-1, 3))
        start += count * corners
    return np.concatenate(fans).astype(np.uint32)


def _tones(faces: Faces) -> Float[np.ndarray, " f"]:
    """Choose the tones of plain walls, darker where they turn from the light."""
    across = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 1])
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    lit = np.clip((1.0 + across[:, :2] @ LIGHT) / 2.0, 0.0, 1.0)
    walls = np.array(TONES)[1 + np.round(lit * (len(TONES) - 2)).astype(int)]
    return np.where(across[:, 2] > 0.5, float(ROOF), walls)


def _linear(tones: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    """Turn 8-bit sRGB grays into linear light (IEC 61966-2-1)."""
    share = tones / 255.0
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
