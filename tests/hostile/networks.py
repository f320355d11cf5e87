"""Folders of networks and their locks: broken, swapped, nested, relocked."""

import hashlib
import json
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, Final

import numpy as np
import onnx
from onnx import TensorProto, helper

from tests.hostile.case import Case, Make
from tests.hostile.pictures import encoded, street
from tests.pipelines import painted

LOCK: Final = "models.lock"
SEGMENT: Final = "segment.onnx"


@cache
def sound() -> dict[str, bytes]:
    made = {"segment": painted.segment_network(), "inpaint": painted.inpaint_network()}
    return {f"{name}.onnx": data for name, data in made.items()}


def write_sound(folder: Path, **changed: bytes) -> Path:
    """Write both networks with their lock, some of them changed and relocked."""
    folder.mkdir()
    lock = {}
    for name, data in (sound() | {f"{n}.onnx": d for n, d in changed.items()}).items():
        (folder / name).write_bytes(data)
        lock[name] = hashlib.sha256(data).hexdigest()
    (folder / LOCK).write_text(json.dumps(lock))
    return folder


def explained(spoil: Callable[[Path], object], **changed: bytes) -> Make:
    """Explain a sound photograph with spoiled networks.

    In a small one no facade is found, and its inpainting, which takes time, not asked.
    """
    small = "inpaint" not in changed

    def make(folder: Path) -> list[object]:
        photo = encoded(street(), "PNG") if small else painted.photo()
        (folder / "photo.png").write_bytes(photo)
        spoil(write_sound(folder / "models", **changed))
        options = ["-o", "out", "--models", "models", "--no-placard"]
        return ["explain", "photo.png", *options]

    return make


def locked(text: bytes) -> Make:
    return explained(lambda models: (models / LOCK).write_bytes(text))


def lock_of(**names: Any) -> bytes:
    return json.dumps({f"{name}.onnx": value for name, value in names.items()}).encode()


def relocked(**changed: bytes) -> Make:
    return explained(bool, **changed)


def swapped(models: Path) -> None:
    (models / SEGMENT).write_bytes(sound()["inpaint.onnx"])


def in_place(name: str, put: Callable[[Path], object]) -> Make:
    def spoil(models: Path) -> None:
        (models / name).unlink()
        put(models / name)

    return explained(spoil)


def sparse(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(3 * 1024**3)


def answering(**changed: np.ndarray) -> bytes:
    """Make a segmenting network that gives other constants than it should."""
    _, labels, scores, masks = painted.detections()
    given = {
        "boxes": np.zeros((len(labels), 4), np.float32) + 9,
        "labels": labels,
        "scores": scores,
        "masks": masks,
    } | changed
    nodes = [helper.make_node("Identity", [f"{n}_in"], [n]) for n in given]
    constants, answers = painted.of_planes()
    nodes += [helper.make_node("Shape", ["image"], ["shape"]), *answers]
    constants |= {f"{name}_in": value for name, value in given.items()}
    kinds = {n: helper.np_dtype_to_tensor_dtype(v.dtype) for n, v in given.items()}
    kinds |= {"pixels": TensorProto.FLOAT, "indoors": TensorProto.FLOAT}
    return painted.network(nodes, constants, ["image"], kinds)


def asking(*inputs: str) -> bytes:
    """Make a network that wants other inputs."""
    nodes = [helper.make_node("Identity", [name], [f"{name}_out"]) for name in inputs]
    kinds = {f"{name}_out": TensorProto.FLOAT for name in inputs}
    return painted.network(nodes, {}, list(inputs), kinds)


def outside() -> bytes:
    """Make a network whose numbers lie in a file of this machine."""
    made = onnx.load_from_string(painted.segment_network())
    told = made.graph.initializer[0]
    told.ClearField("raw_data")
    told.data_location = TensorProto.EXTERNAL
    for key, value in (("location", "../../../../etc/passwd"), ("length", "48")):
        entry = told.external_data.add()
        entry.key, entry.value = key, value
    return made.SerializeToString()


def unknown(domain: str) -> bytes:
    nodes = [helper.make_node("Nonsense", ["image"], ["boxes"], domain=domain)]
    return painted.network(nodes, {}, ["image"], {"boxes": TensorProto.FLOAT})


def cases() -> list[Case]:
    """List all hostile networks; each is told with the name of its file."""
    return [*locks(), *files(), *relocks()]


def locks() -> list[Case]:
    said = (LOCK,)
    texts = {
        "nothing": b"",
        "a brace": b"{",
        "a list": b"[]",
        "null": b"null",
        "a word": b'"segment.onnx"',
        "no names": b"{}",
        "other names": lock_of(other="0" * 64),
        "numbers for hashes": lock_of(segment=1, inpaint=2),
        "lists for hashes": lock_of(segment=["0" * 64], inpaint=[]),
        "nested 100,000 deep": b"[" * 100_000,
        "nested and closed": b'{"segment.onnx":' * 50_000 + b"1" + b"}" * 50_000,
        "a long number": b'{"segment.onnx": ' + b"9" * 10_000 + b"}",
        "no UTF-8": b'{"\xff": ""}',
        "zeros": bytes(4096),
        "half of it": lock_of(segment="0" * 64, inpaint="0" * 64)[:40],
        "two of them": lock_of(segment="") * 2,
        "page": b"<!DOCTYPE html><html></html>",
    }
    return [
        *(Case(f"lock: {n}", locked(data), 1, said) for n, data in texts.items()),
        Case("lock: missing", in_place(LOCK, bool), 1, said),
        Case("lock: folder", in_place(LOCK, Path.mkdir), 1, said),
        Case("lock: pipe", in_place(LOCK, os.mkfifo), 1, said),
        Case("lock: endless device", in_place(LOCK, zero), 1, said),
        Case("lock: sparse file of 3 GB", in_place(LOCK, sparse), 1, said),
        Case("lock: wrong hash", locked(lock_of(segment="0" * 64)), 1, (SEGMENT,)),
        Case("lock: path for a hash", locked(lock_of(segment="../x")), 1, (SEGMENT,)),
    ]


def zero(path: Path) -> None:
    path.symlink_to("/dev/zero")


def files() -> list[Case]:
    said = (SEGMENT,)
    return [
        Case("file: missing", in_place(SEGMENT, bool), 1, said),
        Case("file: folder", in_place(SEGMENT, Path.mkdir), 1, said),
        Case("file: pipe", in_place(SEGMENT, os.mkfifo), 1, said),
        Case("file: endless device", in_place(SEGMENT, zero), 1, said),
        Case("file: sparse file of 3 GB", in_place(SEGMENT, sparse), 1, said),
        Case("file: empty", in_place(SEGMENT, Path.touch), 1, said),
        Case("file: another network", explained(swapped), 1, said),
    ]


def relocks() -> list[Case]:
    whole = sound()[SEGMENT]
    said, other = (SEGMENT,), ("inpaint.onnx",)
    nothing = np.zeros((0, 4), np.float32)
    none = {"boxes": nothing, "labels": np.zeros(0, np.int64)}
    none |= {
        "scores": np.zeros(0, np.float32),
        "masks": np.zeros((0, 28, 28), np.float32),
    }
    nan = np.full((3, 4), np.nan, np.float32)
    strange = np.array([77, -1, 2**40])
    segment = {
        "empty": b"",
        "cut in half": whole[: len(whole) // 2],
        "zeros": bytes(4096),
        "words": b"no network at all " * 99,
        "zeros within": whole[:200] + bytes(64) + whole[264:],
        "numbers of another file": outside(),
        "an unknown step": unknown(""),
        "a step of a stranger": unknown("com.example"),
        "two inputs": asking("image", "other"),
        "one output": asking("image"),
        "boxes of three": answering(boxes=np.zeros((3, 3), np.float32)),
        "more boxes than scores": answering(boxes=np.zeros((9, 4), np.float32)),
        "boxes no numbers": answering(boxes=nan),
        "labels of nothing": answering(labels=strange),
        "masks flat": answering(masks=np.zeros((3, 28), np.float32)),
    }
    inpaint = {
        "cut in half": sound()["inpaint.onnx"][:150],
        "one input": asking("image"),
    }
    fine = {"writes": "out"}
    return [
        *(
            Case(f"relocked: {n}", relocked(segment=d), 1, said)
            for n, d in segment.items()
        ),
        *(
            Case(f"relocked inpaint: {n}", relocked(inpaint=d), 1, other)
            for n, d in inpaint.items()
        ),
        Case("sees nothing", relocked(segment=answering(**none)), 0, **fine),
    ]
