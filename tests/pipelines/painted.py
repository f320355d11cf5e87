"""Small photos of two fronts with a car before them, and networks that find these."""

import hashlib
import json
from pathlib import Path

import cv2
import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

from nostalgin_core.steps import Networks
from pipelines.index.index import index
from pipelines.models import Models

SIZE = (640, 480)  # h, w
# The left one fills the middle of the picture: it is the one that is meant.
LEFT = np.array([[40, 80], [270, 140], [270, 560], [40, 600]], np.float32)
RIGHT = np.array([[290, 140], [450, 100], [450, 590], [290, 560]], np.float32)
CAR = (80, 524, 200, 600)  # x0, y0, x1, y1


def photo(seed: int = 0, *, suffix: str = ".png") -> bytes:
    """Paint two fronts in perspective with windows, and a car; encode them."""
    rng = np.random.default_rng(seed)
    image = np.full(SIZE, 225, np.uint8)
    image[560:] = 120
    for quad in (LEFT, RIGHT):
        across, up = 4 + int(rng.integers(3)), 5 + int(rng.integers(3))
        wall = np.full((400, 200), 150 + rng.integers(30), np.uint8)
        for y in np.linspace(20, 400, up, endpoint=False).astype(int):
            wall[y - 14 : y - 8] = 240  # a string course below each row of windows
            for x in np.linspace(12, 200, across, endpoint=False).astype(int):
                wall[y : y + 36, x : x + 22] = rng.integers(20, 70)
        corners = np.array([[0, 0], [200, 0], [200, 400], [0, 400]], np.float32)
        matrix = cv2.getPerspectiveTransform(corners, quad)
        warped = cv2.warpPerspective(wall, matrix, SIZE[::-1])
        inside = cv2.warpPerspective(np.ones_like(wall), matrix, SIZE[::-1]) > 0
        image[inside] = warped[inside]
    x0, y0, x1, y1 = CAR
    image[y0:y1, x0:x1] = 30
    image = np.clip(image + rng.normal(0, 3, SIZE), 0, 255).astype(np.uint8)
    return cv2.imencode(suffix, image)[1].tobytes()


def detections() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """List boxes as shares of the picture, labels, scores and masks."""
    boxes, masks = [], []
    for quad in (LEFT, RIGHT):
        low, high = quad.min(axis=0), quad.max(axis=0)
        boxes.append([*low, *high])
        inner = np.rint((quad - low) / (high - low) * 27).astype(np.int32)
        masks.append(cv2.fillPoly(np.zeros((28, 28), np.float32), [inner], 0.98))
    boxes.append(list(CAR))
    masks.append(np.full((28, 28), 0.95, np.float32))
    shares = np.array(boxes, np.float32) / np.array([*SIZE[::-1]] * 2, np.float32)
    labels = np.array([1, 1, 3], np.int64)
    scores = np.array([0.95, 0.9, 0.8], np.float32)
    return shares, labels, scores, np.array(masks)


def pixels() -> np.ndarray:
    """Tell what every fourth pixel is: ground, front, what hides it, a front's end."""
    kinds = np.zeros(SIZE, np.uint8)
    ends = np.zeros(SIZE, np.uint8)
    for quad in (LEFT, RIGHT):
        corners = np.rint(quad).astype(np.int32)
        cv2.fillPoly(kinds, [corners], 1)
        cv2.polylines(ends, [corners], isClosed=True, color=1, thickness=4)
    kinds[CAR[1] : CAR[3], CAR[0] : CAR[2]] = 2
    planes = [np.where(kinds == kind, 0.96, 0.02) for kind in range(3)]
    return np.stack([*planes, 0.98 * ends])[:, 2::4, 2::4].astype(np.float32)


def of_planes() -> tuple[dict[str, np.ndarray], list[onnx.NodeProto]]:
    """Give the constants and steps that answer for pixels of an image's `shape`.

    No cell of them is in a room.
    """
    constants = {
        "sides": np.array([2, 3], np.int64),  # h, w
        "stride": np.array(4, np.int64),
        "first": np.array([1, 4], np.int64),
        "axis": np.array([0], np.int64),
        "planes": pixels()[None],
        "coarsest": np.array(32, np.int64),
        "single": np.array([1], np.int64),
        "outdoors": np.array(-9, np.float32),
    }
    nodes = [
        helper.make_node("Gather", ["shape", "sides"], ["whole"]),
        helper.make_node("Div", ["whole", "stride"], ["cells"]),
        helper.make_node("Concat", ["first", "cells"], ["wanted"], axis=0),
        helper.make_node(
            "Resize", ["planes", "", "", "wanted"], ["resized"], mode="linear"
        ),
        helper.make_node("Squeeze", ["resized", "axis"], ["pixels"]),
        helper.make_node("Div", ["whole", "coarsest"], ["few"]),
        helper.make_node("Concat", ["single", "few"], ["grid"], axis=0),
        helper.make_node("Expand", ["outdoors", "grid"], ["indoors"]),
    ]
    return constants, nodes


def segment_network() -> bytes:
    """Make a network that sees the same three things in every picture."""
    shares, labels, scores, masks = detections()
    constants = {
        "shares": shares,
        "labels": labels,
        "scores": scores,
        "masks": masks,
        "order": np.array([3, 2, 3, 2], np.int64),  # w, h, w, h
    }
    nodes = [
        helper.make_node("Shape", ["image"], ["shape"]),
        helper.make_node("Gather", ["shape", "order"], ["extent"]),
        helper.make_node("Cast", ["extent"], ["extent32"], to=TensorProto.FLOAT),
        helper.make_node("Mul", ["shares", "extent32"], ["boxes"]),
    ]
    more, answering = of_planes()
    constants |= more
    nodes += answering
    nodes += [
        helper.make_node("Identity", [name], [f"{name}_out"])
        for name in ("labels", "scores", "masks")
    ]
    kinds = {"boxes": 1, "labels_out": 7, "scores_out": 1, "masks_out": 1}
    kinds |= {"pixels": 1, "indoors": 1}
    return network(nodes, constants, ["image"], kinds)


def network(
    nodes: list, constants: dict[str, np.ndarray], inputs: list[str], outputs: dict
) -> bytes:
    """Put nodes into an ONNX file with one-channel pictures as input."""
    shape = [1, 1, "h", "w"]
    graph = helper.make_graph(
        nodes,
        "painted",
        [helper.make_tensor_value_info(n, TensorProto.FLOAT, shape) for n in inputs],
        [helper.make_tensor_value_info(n, k, None) for n, k in outputs.items()],
        [numpy_helper.from_array(value, name) for name, value in constants.items()],
    )
    opset = [helper.make_opsetid("", 17)]
    return helper.make_model(
        graph, opset_imports=opset, ir_version=9
    ).SerializeToString()


def write_models(folder: Path, **networks: bytes) -> Path:
    """Write networks with their lock."""
    folder.mkdir(parents=True, exist_ok=True)
    lock = {}
    for name, data in networks.items():
        (folder / f"{name}.onnx").write_bytes(data)
        lock[f"{name}.onnx"] = hashlib.sha256(data).hexdigest()
    (folder / "models.lock").write_text(json.dumps(lock))
    return folder


def networks(folder: Path) -> Networks:
    """Write small networks to a folder, and load them."""
    made = {"segment": segment_network(), "inpaint": inpaint_network()}
    models = Models(str(write_models(folder, **made)))
    return Networks(models.load("segment"), models.load("inpaint"))


def inpaint_network() -> bytes:
    """Make a network that answers with its guess, a little darker."""
    nodes = [
        helper.make_node("Sub", ["guess", "shade"], ["mixed"]),
        helper.make_node("Add", ["image", "hole"], ["unused"]),
    ]
    constants = {"shade": np.array(0.1, np.float32)}
    inputs = ["image", "hole", "guess"]
    return network(nodes, constants, inputs, {"mixed": 1, "unused": 1})


CATALOGUE = """photo,block,lot,street,address,width_m
5_1.png,5,1,Elm Street,1,10
5_2.jpg,5,2,Elm Street,3,8
5_2a.png,5,2,Elm Street,3,8
,5,3,Elm Street,5,9
6_1.png,6,1,Oak Street,2,7
"""


def write_city(folder: Path) -> Path:
    """Write photos of two blocks, one lot without a photo, and their manifest."""
    photos = folder / "photos"
    photos.mkdir(parents=True)
    for seed, name in enumerate(("5_1.png", "5_2.jpg", "5_2a.png", "6_1.png")):
        (photos / name).write_bytes(photo(seed, suffix=Path(name).suffix))
    (folder / "list.csv").write_text(CATALOGUE)
    index(photos, folder / "list.csv", str(folder / "city"))
    models = {"segment": segment_network(), "inpaint": inpaint_network()}
    write_models(folder / "models", **models)
    return folder / "city"
