"""Cities of many tiny photographs, and what a command on one of them costs."""

import csv
import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np

from tests.pipelines import painted

LOTS = 12  # of a block
SEEDS = 20  # different pictures; each photograph has pixels of its own beside
SHARE = 0.25  # of the size that tests use: a photograph costs as little as can be
KIB = 1024


class Cost(NamedTuple):
    """What a command took, with the processes that it started and waited for."""

    cpu_s: float
    wall_s: float
    peak_gb: float  # of the largest process


def archive(folder: Path, photos: int, *, own: bool = True) -> Path:
    """Write photographs, a list and small networks, and index them.

    Unless each has pixels of its `own`, blocks show the same few pictures: stages find
    all but the first made, and as many references pass.
    """
    (folder / "photos").mkdir(parents=True)
    pictures = [small(seed) for seed in range(min(SEEDS, photos))]
    rows = []
    for number in range(photos):
        block, lot = number // LOTS + 1, number % LOTS + 1
        name = f"{block}_{lot}.png"
        image = pictures[number % len(pictures)].copy()
        digits = [number >> shift & 255 for shift in (0, 8, 16)]
        image[-1, :3] = digits if own else 0  # on the ground, where no front is
        (folder / "photos" / name).write_bytes(cv2.imencode(".png", image)[1].tobytes())
        street = f"{lot * 4 // (LOTS + 1)} Street {block}"
        rows.append([name, block, lot, street, 2 * lot, 6 + number % 5])
    with (folder / "list.csv").open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["photo", "block", "lot", "street", "address", "width_m"])
        out.writerows(rows)
    networks = {
        "segment": painted.segment_network(),
        "inpaint": painted.inpaint_network(),
    }
    painted.write_models(folder / "models", **networks)
    indexed(folder)
    return folder / "city"


def small(seed: int) -> np.ndarray:
    """Paint a tiny photograph."""
    data = np.frombuffer(painted.photo(seed), np.uint8)
    image = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE)
    assert image is not None
    size = None
    return cv2.resize(image, size, fx=SHARE, fy=SHARE, interpolation=cv2.INTER_AREA)


def indexed(folder: Path) -> None:
    """Index an archive that `archive` wrote."""
    listed = ["--catalogue", str(folder / "list.csv"), "--boards", "none"]
    words = ["index", str(folder / "photos"), *listed, "-o", str(folder / "city")]
    command([*words, "-q"])


def command(words: Sequence[str]) -> Cost:
    """Run one of our commands to its end; it has to come to a good one."""
    began = time.perf_counter()
    line = [sys.executable, "-m", "pipelines.cli", *words]
    running = subprocess.Popen(line, stderr=subprocess.PIPE)
    said = running.stderr.read().decode() if running.stderr else ""
    _, status, used = os.wait4(running.pid, 0)
    running.returncode = os.waitstatus_to_exitcode(status)
    if running.returncode:
        sys.exit(
            f"{' '.join(words[:2])} ended with {running.returncode}: {said[-900:]}"
        )
    wall_s, cpu_s = time.perf_counter() - began, used.ru_utime + used.ru_stime
    return Cost(cpu_s, wall_s, used.ru_maxrss * KIB / 1e9)


def built(city: Path, *words: str, what: str = "build") -> Cost:
    """Build a city, or do something else with it."""
    models = ["--models", str(city.parent / "models")]
    return command([what, str(city), *models, *words])


def record(city: Path) -> dict:
    """Read what the published run tells of itself."""
    run = (city / "CURRENT").read_text().strip()
    return json.loads((city / "runs" / run / "run.json").read_text())
