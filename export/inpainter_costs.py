"""What widths, strides and slices cost: the paper's table 4 and its sweep.

    python -m export.inpainter_costs [--table | --sweep] [--size 1200] [--json]

Costs don't depend on what a network learnt, so all but the shipped one have random
weights. The baseline is the free-form network as the paper counts it: width 26,
attention of stride 1, the whole image at once, its score map in one piece. Each figure
is taken in a process of its own, on one thread: seconds on the wall and of the CPU, and
by how much the process grew at its highest.

`--report FILE`, made by `nostalgin evaluate inpainting DATA --json`, adds l1 and l2 to
the sweep where a network of that width and stride is trained: the shipped one.
"""

import argparse
import hashlib
import json
import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np

from nostalgin_core import evidence, session
from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.inpaint.inpaint import Network, low_memory, whole
from nostalgin_core.measure.inpainting import elevation

MODELS = Path(__file__).parents[1] / "nostalgin_core" / "models"
BASELINE = (26, 1)  # width and stride (paper, section 4.3)
OURS = (20, 2)
WIDTHS = (12, 16, 20, 26, 32)
STRIDES = (1, 2, 3, 4)
TABLE_PX = 1200
SWEPT_PX = 480  # stride 1 needs memory that grows with the square of the area
HIDDEN = 0.12
SLACK = 0.01  # texels of a hole that were rounded away


class Cost(NamedTuple):
    """What one run took."""

    wall_s: float
    cpu_s: float
    grown_mb: float


def front(size: int, *, hidden: float = HIDDEN) -> tuple[Gray, Mask]:
    """Paint a square front that repeats, with people at its foot."""
    rng = np.random.default_rng(0)
    x, y = np.arange(size), np.arange(size)[:, None]
    pane = (x % (size // 7) > size // 21) & (y % (size // 6) > size // 12)
    image = np.where(pane, np.uint8(70), np.uint8(160))
    image += rng.integers(0, 20, (size, size), np.uint8)
    hole = np.zeros((size, size), bool)
    tall, wide = round(0.3 * size), round(0.08 * size)
    while hole.mean() < hidden - SLACK:
        left = rng.integers(0, size - wide)
        hole[size - tall :, left : left + wide] = True
    return image, hole


def untrained(width: int, stride: int) -> bytes:
    """Write a network of random weights, its attention in one piece.

    Only here is torch needed: the measuring processes stay free of its memory.
    """
    import torch  # noqa: PLC0415

    from export.inpainter import Generator  # noqa: PLC0415
    from export.inpainter_onnx import export  # noqa: PLC0415

    torch.manual_seed(0)
    return export(Generator(width=width, stride=stride), strips=1, facts={})


def look(network: Network, image: Gray, hole: Mask) -> None:
    """Let a network look at a whole image at its own size, as the paper does."""
    shown = (image.astype(np.float32) / 127.5 - 1)[None, None]
    hidden = hole.astype(np.float32)[None, None]
    network(shown * (1 - hidden), hidden, shown * (1 - hidden))


def highest_mb() -> float:
    """Say how large this process has been at its highest (Linux).

    `ru_maxrss` would not do: a child begins with its parent's.
    """
    told = Path("/proc/self/status").read_text()
    line = next(line for line in told.splitlines() if line.startswith("VmHWM"))
    return int(line.split()[1]) / 1024


def cost(how: str, size: int, file: bytes) -> Cost:
    """Measure one way of filling one picture; loading the network is not counted."""
    image, hole = front(size)
    network = session.load(file, hashlib.sha256(file).hexdigest())
    marks = np.where(hole, evidence.INPAINTED, evidence.PHOTOGRAPHED).astype(np.uint8)
    given = elevation(image, marks)
    before = highest_mb()
    wall, cpu = time.perf_counter(), time.process_time()
    if how == "network":
        look(network, image, hole)
    else:
        (low_memory if how == "low memory" else whole)(given, network)
    spent = time.perf_counter() - wall, time.process_time() - cpu
    return Cost(*spent, highest_mb() - before)


def apart(how: str, size: int, file: bytes) -> Cost:
    """Measure in a process of its own, whose peak nothing else has raised."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(cost, how, size, file).result()


def table(size: int) -> list[dict[str, float | str]]:
    """Reckon what is saved against the baseline: the paper's table 4."""
    base = apart("network", size, untrained(*BASELINE))
    slim = apart("network", size, untrained(*OURS))
    shipped = (MODELS / "inpaint.onnx").read_bytes()
    rows = {
        f"width {BASELINE[0]}, stride {BASELINE[1]}, whole": base,
        f"width {OURS[0]}, stride {OURS[1]}, whole": slim,
        "shipped, whole": apart("whole", size, shipped),
        "shipped, low memory": apart("low memory", size, shipped),
    }
    return [
        {
            "name": name,
            **row._asdict(),
            "wall_saved": 1 - row.wall_s / base.wall_s,
            "cpu_saved": 1 - row.cpu_s / base.cpu_s,
            "memory_saved": 1 - row.grown_mb / base.grown_mb,
        }
        for name, row in rows.items()
    ]


def sweep(size: int, trained: dict[str, float] | None) -> list[dict[str, float | str]]:
    """Measure other widths at our stride, and other strides at our width."""
    pairs = {(w, OURS[1]) for w in WIDTHS} | {(OURS[0], s) for s in STRIDES}
    rows = []
    for width, stride in sorted(pairs | {BASELINE}):
        row = {"width": width, "stride": stride}
        row |= apart("network", size, untrained(width, stride))._asdict()
        known = trained if (width, stride) == OURS else None
        row |= {k: known[k] if known else "not trained" for k in ("l1", "l2")}
        rows.append(row)
    return rows


def text(rows: list[dict[str, float | str]]) -> str:
    """Write rows as a table, as wide as its columns need."""
    cells = [list(rows[0])] + [
        [f"{v:.3g}" if isinstance(v, float) else str(v) for v in row.values()]
        for row in rows
    ]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return "\n".join(
        "  ".join(v.rjust(w) for v, w in zip(line, widths, strict=True))
        for line in cells
    )


def main() -> None:
    """Print table 4, the sweep, or both."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--table", action="store_true", help="table 4 alone")
    parser.add_argument("--sweep", action="store_true", help="the sweep alone")
    parser.add_argument("--size", type=int, help="px, a multiple of 48")
    parser.add_argument("--report", type=Path, help="of nostalgin evaluate inpainting")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    if given.size is not None and given.size % 48:
        parser.error(f"--size must be a multiple of 48, not {given.size}")
    trained = None
    if given.report:
        free = json.loads(given.report.read_text())["holes"]["free"]
        trained = free["methods"]["ours-low-memory"]
    both = given.table == given.sweep
    report = {}
    if both or given.table:
        report["table 4"] = table(given.size or TABLE_PX)
    if both or given.sweep:
        report["sweep"] = sweep(given.size or SWEPT_PX, trained)
    if given.json:
        print(json.dumps(report, indent=1))
        return
    for name, rows in report.items():
        print(f"{name}\n{text(rows)}\n", flush=True)


if __name__ == "__main__":
    main()
