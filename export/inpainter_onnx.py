"""Write the trained inpainter as ONNX, of any size, and prove that it is the same.

    python -m export.inpainter_onnx CHECKPOINT MODELS

Facts that a reader of the file needs lie inside it, as metadata.
"""

import argparse
import hashlib
import io
import warnings
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from export.inpainter import MULTIPLE, Generator
from export.shipping import lock, shipped
from nostalgin_core import session

STRIPS = 8  # of the attention: its score map is an eighth of the whole one
TOLERANCE = 2e-2  # of the range -1 to 1: what float16 weights cost, about 1 gray level
NAME = "inpaint.onnx"


class Shipped(nn.Module):
    """The generator as the pipeline calls it: one answer, attention in strips."""

    def __init__(self, generator: Generator, *, strips: int = STRIPS) -> None:
        """Wrap a trained generator."""
        super().__init__()
        self.generator = generator
        self.strips = strips

    def forward(self, image: Tensor, hole: Tensor, guess: Tensor) -> Tensor:
        """Give the refined image alone."""
        return self.generator(image, hole, guess, strips=self.strips)[1]


def export(
    generator: Generator, *, strips: int = STRIPS, facts: dict[str, str]
) -> bytes:
    """Write a generator as ONNX with free height and width, multiples of 8."""
    example = tuple(torch.rand(1, 1, 64, 96) for _ in range(3))
    names = ["image", "hole", "guess"]
    size = {2: "height", 3: "width"}
    written = io.BytesIO()
    with warnings.catch_warnings():
        # The tracer warns of each comparison of sizes; parity at other sizes decides.
        warnings.simplefilter("ignore")
        torch.onnx.export(
            Shipped(generator.eval(), strips=strips),
            example,
            written,  # pyright: ignore[reportArgumentType] - it takes a buffer
            input_names=names,
            output_names=["filled"],
            dynamic_axes=dict.fromkeys([*names, "filled"], size),
            opset_version=17,
            dynamo=False,
        )
    return shipped(written.getvalue(), facts={"multiple": str(MULTIPLE), **facts})


def parity(generator: Generator, data: bytes, shapes: list[tuple[int, int]]) -> float:
    """Give the largest difference between torch and ONNX Runtime over some sizes."""
    opened = session.load(data, hashlib.sha256(data).hexdigest())
    worst = 0.0
    rng = np.random.default_rng(0)
    for h, w in shapes:
        image, guess = rng.uniform(-1, 1, (2, 1, 1, h, w)).astype(np.float32)
        hole = np.zeros((1, 1, h, w), np.float32)
        hole[..., h // 3 : h // 2, w // 4 : w // 2] = 1
        guess = image * (1 - hole) + guess * hole
        (ours,) = opened(image, hole, guess)
        with torch.no_grad():
            theirs = generator(*map(torch.from_numpy, (image, hole, guess)))[1].numpy()
        worst = max(worst, float(np.abs(ours - theirs).max()))
    return worst


def main() -> None:
    """Export a checkpoint's averaged weights; fail if the two runtimes disagree."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("models", type=Path)
    options = parser.parse_args()
    state = torch.load(options.checkpoint, weights_only=True)
    recipe = state["recipe"]
    generator = Generator(width=recipe["width"], stride=recipe["stride"])
    generator.load_state_dict(state["averaged"])
    generator.eval()
    facts = {"steps": str(state["step"]), "width": str(recipe["width"])}
    data = export(generator, facts=facts)
    off = parity(generator, data, [(64, 96), (128, 72), (200, 104)])
    print(f"{len(data)} bytes, torch and ONNX Runtime differ by at most {off:.2e}")
    if off > TOLERANCE:
        raise ValueError(f"the export differs by {off}, more than {TOLERANCE}")
    lock(options.models / NAME, data)


if __name__ == "__main__":
    main()
