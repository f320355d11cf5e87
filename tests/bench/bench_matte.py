"""Print what matting costs beside pymatting's closed form, on the same trimap.

Run with `python tests/bench/bench_matte.py`, and with the folder of alphamatting.com's
low-resolution images as an argument to compare errors against true alpha, too. Each
method runs in a process of its own, so that peaks of memory are its own. The peer gets
the gray image three times, as it asks for three channels, and runs once on a small
image first: it compiles itself for half a minute.
"""

import argparse
import multiprocessing
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from nostalgin_core.matte import closed_form
from nostalgin_core.matte.trimap import BACKGROUND, FOREGROUND, UNKNOWN, signed_distance


def front(h: int, w: int, *, band_px: int) -> tuple[np.ndarray, np.ndarray]:
    """Paint a textured front before a sky, and a trimap along its outline."""
    rng = np.random.default_rng(3)
    outline = np.array([[0.2, 0.9], [0.22, 0.3], [0.5, 0.1], [0.8, 0.25], [0.78, 0.9]])
    inside = np.zeros((h, w), np.uint8)
    cv2.fillPoly(inside, [np.round(outline * [w, h]).astype(np.int32)], 1)
    cells = rng.uniform(60, 130, (h // 24 + 1, w // 18 + 1)).astype(np.float32)
    wall = cv2.resize(cells, (w, h), interpolation=cv2.INTER_NEAREST)
    sky = np.linspace(215, 190, h, dtype=np.float32)[:, None]
    soft = cv2.GaussianBlur(inside.astype(np.float32), (0, 0), 1.2)
    image = soft * wall + (1 - soft) * sky + rng.normal(0, 2.5, (h, w))
    depth = signed_distance(inside > 0)
    known = np.where(depth > 0, FOREGROUND, BACKGROUND)
    known[np.abs(depth) < band_px / 2] = UNKNOWN
    return np.clip(image, 0, 255).astype(np.uint8), known.astype(np.uint8)


def ours(image: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Solve the band alone."""
    return closed_form.alpha(image, known)


def peer(image: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Run pymatting's closed form: whole Laplacian, incomplete Cholesky, CG."""
    from pymatting import estimate_alpha_cf  # noqa: PLC0415 - it compiles for long

    return estimate_alpha_cf(np.dstack([image / 255.0] * 3), known / 255.0)


def measured(
    method: Callable[..., np.ndarray], image: np.ndarray, known: np.ndarray, pipe: Any
) -> None:
    """Send alpha, CPU seconds and by how much memory grew at its peak, in MB."""
    warnings.simplefilter("ignore")
    method(*front(96, 128, band_px=10))
    Path("/proc/self/clear_refs").write_text("5")  # forget earlier peaks
    before = memory_mb("VmRSS")
    start = time.process_time()
    alpha = method(image, known)
    seconds = time.process_time() - start
    pipe.send((alpha.astype(np.float32), seconds, memory_mb("VmHWM") - before))


def memory_mb(name: str) -> float:
    """Read one of the kernel's figures of this process."""
    lines = Path("/proc/self/status").read_text().splitlines()
    line = next(line for line in lines if line.startswith(name + ":"))
    return int(line.split()[1]) / 1024


def alone(
    method: Callable[..., np.ndarray], image: np.ndarray, known: np.ndarray
) -> tuple[np.ndarray, float, float]:
    """Run a method in a fresh process."""
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=measured, args=(method, image, known, sender))
    process.start()
    sender.close()
    result = receiver.recv()
    process.join()
    return result


def sizes() -> None:
    """Compare cost and memory on painted fronts."""
    for h, w in ((800, 1200), (3000, 2048)):
        image, known = front(h, w, band_px=40)
        unknown = known == UNKNOWN
        theirs, peer_seconds, peer_peak = alone(peer, image, known)
        print(
            f"{w}x{h}, {np.count_nonzero(unknown)} unknown: "
            f"pymatting {peer_seconds:.2f} CPU s, {peer_peak:.0f} MB"
        )
        alpha, seconds, peak = alone(ours, image, known)
        off = np.abs(alpha - theirs)
        print(
            f"  ours {seconds:.2f} CPU s, {peak:.0f} MB: "
            f"{peer_seconds / seconds:.1f} times less, "
            f"{peer_peak / max(peak, 1):.1f} times smaller; mean difference "
            f"{off.mean():.5f} (in the band {off[unknown].mean():.5f})",
            flush=True,
        )


def errors(folder: Path) -> None:
    """Compare errors against true alpha, image by image."""
    rows = []
    for path in sorted((folder / "Images").glob("*.png")):
        image, known, truth = (
            cv2.imread(str(folder / kind / path.name), cv2.IMREAD_GRAYSCALE)
            for kind in ("Images", "Trimap1", "GroundTruth")
        )
        unknown = (known != FOREGROUND) & (known != BACKGROUND)
        row = []
        for method in (ours, peer):
            start = time.process_time()
            alpha = method(image, known)
            seconds = time.process_time() - start
            row += [((alpha - truth / 255.0)[unknown] ** 2).mean(), seconds]
        rows.append(row)
        print(
            f"{path.stem}: MSE {row[0]:.4f} in {row[1]:.2f} CPU s, "
            f"pymatting {row[2]:.4f} in {row[3]:.2f}",
            flush=True,
        )
    mean = np.mean(rows, axis=0)
    print(
        f"mean: MSE {mean[0]:.4f} in {mean[1]:.2f} CPU s, "
        f"pymatting {mean[2]:.4f} in {mean[3]:.2f}"
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("matting", nargs="?", type=Path)
    folder = parser.parse_args().matting
    sizes()
    if folder is not None:
        errors(folder)
