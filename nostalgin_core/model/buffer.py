"""The binary half of a GLB: arrays and texts as views into one buffer.

Equal arrays are written once. Nothing here knows what the arrays mean.
"""

import json
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Json = dict[str, Any]

FLOAT, UNSIGNED_SHORT, UNSIGNED_INT = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


@dataclass(slots=True)
class Buffer:
    """The binary chunk while it grows, and the views into it."""

    data: bytearray = field(default_factory=bytearray)
    views: list[Json] = field(default_factory=list)
    accessors: list[Json] = field(default_factory=list)
    known: dict[tuple[bytes, str, str], int] = field(default_factory=dict)


def vertices(
    buffer: Buffer, values: np.ndarray, kind: str, *, bounds: bool = False
) -> int:
    """Add what the vertices carry, as floats of 32 bits, and return its accessor."""
    # adding zero turns -0.0, which prints differently, into 0.0
    array = np.ascontiguousarray(values, np.float32) + np.float32(0.0)
    return accessor(buffer, array, kind, target=ARRAY_BUFFER, bounds=bounds)


def accessor(
    buffer: Buffer, array: np.ndarray, kind: str, *, target: int, bounds: bool = False
) -> int:
    """Add an array and return its accessor; equal arrays share one."""
    data = array.tobytes()
    same = (data, kind, array.dtype.str)
    if same in buffer.known:
        return buffer.known[same]
    code = {"f": FLOAT, "H": UNSIGNED_SHORT, "I": UNSIGNED_INT}[array.dtype.char]
    made: Json = {
        "bufferView": view(buffer, data, target=target),
        "componentType": code,
        "count": len(array),
        "type": kind,
    }
    if bounds:
        made["min"] = [float(value) for value in array.min(axis=0)]
        made["max"] = [float(value) for value in array.max(axis=0)]
    buffer.accessors.append(made)
    buffer.known[same] = len(buffer.accessors) - 1
    return buffer.known[same]


def view(buffer: Buffer, data: bytes, *, target: int | None = None) -> int:
    """Append bytes and return their view."""
    buffer.data.extend(bytes(-len(buffer.data) % 8))  # the property table wants 8
    made: Json = {
        "buffer": 0,
        "byteOffset": len(buffer.data),
        "byteLength": len(data),
    }
    if target is not None:
        made["target"] = target
    buffer.data.extend(data)
    buffer.views.append(made)
    return len(buffer.views) - 1


def strings(buffer: Buffer, values: Sequence[str]) -> Json:
    """Add a column of texts: all bytes in a row, and where each text begins."""
    encoded = [value.encode() for value in values]
    offsets = np.cumsum([0] + [len(item) for item in encoded]).astype(np.uint32)
    # a view may not be empty: with no text at all one byte stands there unread
    return {
        "values": view(buffer, b"".join(encoded) or b"\0"),
        "stringOffsets": view(buffer, offsets.tobytes()),
        "stringOffsetType": "UINT32",
    }


def container(document: Json, binary: bytes) -> bytes:
    """Join both chunks, each padded so that the whole is a multiple of 8 bytes."""
    binary += bytes(-len(binary) % 8)
    document = {**document, "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-(len(text) + 4) % 8)  # 12 + 8 bytes stand before it
    total = 12 + 8 + len(text) + 8 + len(binary)
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, total),
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(binary), b"BIN\0"),
            binary,
        ]
    )
