"""What the inpainter costs, as ratios against a named baseline in the same run.

    python tests/bench/bench_inpaint.py [MODELS]

The baseline of table 4 is the free-form network as the paper counts it (width 26,
attention of stride 1, the whole image at once) with random weights; it is taken at a
small size, since its memory grows with the square of the area. CPU seconds, one
thread; peaks are of the process that ran the one thing.
"""

import io
import json
import multiprocessing
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from nostalgin_core import evidence, session
from nostalgin_core.inpaint.inpaint import low_memory, whole
from nostalgin_core.measure.inpainting import elevation, navier_stokes
from nostalgin_core.records import Elevation

MODELS = Path(__file__).parents[2] / "nostalgin_core" / "models"
Network = Callable[..., tuple[np.ndarray, ...]]


def shipped(models: Path) -> Network:
    """Load the network that is shipped."""
    lock = json.loads((models / "models.lock").read_text())
    return session.load((models / "inpaint.onnx").read_bytes(), lock["inpaint.onnx"])


def baseline(*, width: int, stride: int) -> Network:
    """Write a network of random weights, attention in one piece, and load it."""
    import hashlib  # noqa: PLC0415

    import torch  # noqa: PLC0415

    from export.inpainter import Generator  # noqa: PLC0415
    from export.inpainter_onnx import export  # noqa: PLC0415

    torch.manual_seed(0)
    data = io.BytesIO(
        export(Generator(width=width, stride=stride), strips=1, facts={})
    ).getvalue()
    return session.load(data, hashlib.sha256(data).hexdigest())


def front(h: int, w: int, *, hidden: float) -> Elevation:
    """Paint a front that repeats, with people at its foot."""
    rng = np.random.default_rng(0)
    x, y = np.arange(w), np.arange(h)[:, None]
    pane = (x % (w // 7) > w // 21) & (y % (h // 6) > h // 12)
    image = np.where(pane, np.uint8(70), np.uint8(160))
    image += rng.integers(0, 20, (h, w), np.uint8)
    marks = np.full((h, w), evidence.PHOTOGRAPHED, np.uint8)
    tall, wide = round(0.3 * h), round(0.08 * w)
    while (marks == evidence.INPAINTED).mean() < hidden:
        left = rng.integers(0, w - wide)
        marks[h - tall :, left : left + wide] = evidence.INPAINTED
    return elevation(image, marks)


def measured(task: str) -> tuple[float, float]:
    """Run one thing: CPU seconds, and how much the process grew in MB."""
    name, *size = task.split()
    h, w, hidden = int(size[0]), int(size[1]), float(size[2])
    given = front(h, w, hidden=hidden)
    hole = given.evidence == evidence.INPAINTED
    network = baseline(width=26, stride=1) if name == "free-form" else shipped(MODELS)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.process_time()
    if name == "navier-stokes":
        navier_stokes(given.image, hole)
    elif name == "low-memory":
        low_memory(given, network)
    else:
        whole(given, network)
    spent = time.process_time() - start
    after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return spent, max(after - before, 1) / 1024


def main() -> None:
    """Print table 4 at a small size, then what large elevations cost."""
    table = {
        "480 480 0.04": ("free-form", "whole", "low-memory", "navier-stokes"),
        "1200 800 0.12": ("low-memory", "navier-stokes"),
        "9000 6000 0.005": ("low-memory",),
    }
    context = multiprocessing.get_context("spawn")
    for size, names in table.items():
        first = None
        for name in names:
            with context.Pool(1) as pool:
                spent, grown = pool.apply(measured, (f"{name} {size}",))
            first = first or (spent, grown)
            print(
                f"{size:>16}  {name:<14} {spent:8.2f} CPU s {grown:8.0f} MB more"
                f"   {spent / first[0]:.3f} and {grown / first[1]:.3f} of {names[0]}",
                flush=True,
            )


if __name__ == "__main__":
    if len(sys.argv) > 1:
        MODELS = Path(sys.argv[1])
    main()
