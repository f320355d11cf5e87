"""Kill builds at any moment, build again, and print what was lost.

Run with `python tests/bench/bench_kills.py [KILLS, default 51]`. A painted city is
built by two workers, by two shards at once or by one process; the driver, one of its
descendants (a worker of Beam, a supervisor, a stage's child) or a shard is killed at a
moment drawn from a seed. Then it is built to its end. Printed are, for each kind, how
many ended with the bytes of an undisturbed build, how many artifacts were there after
the kill, how many were made the second time, and how many of those were there already.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tests.pipelines import painted
from tests.pipelines.cities import artifacts, copied, tree

KINDS = ("driver", "worker", "shard")
SEED = 12
WORKERS = "--direct_num_workers=2"


def main(kills: int) -> None:
    """Build once undisturbed, then kill."""
    rng = np.random.default_rng(SEED)
    told: dict[str, list[tuple[bool, int, int, int]]] = defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        city = painted.write_city(Path(folder) / "first")
        began = time.monotonic()
        ended(start(city, (WORKERS,)))
        whole, takes = tree(city), time.monotonic() - began
        for turn in range(kills):
            kind = KINDS[turn % len(KINDS)]
            other = copied(city, Path(folder) / f"{turn}")
            disturbed(other, kind, rng.uniform(0.2, 1.1) * takes, rng)
            told[kind].append(outcome(other, whole))
            shutil.rmtree(other.parent)
    for kind, all_told in told.items():
        same, there, made, twice = map(sum, zip(*all_told, strict=True))
        print(
            f"{kind}: {same} of {len(all_told)} with the same bytes; {there} artifacts "
            f"were there, {made} were made the second time, {twice} of them again"
        )
    if not all(
        same and not twice for one in told.values() for same, _, _, twice in one
    ):
        sys.exit("a build did not recover")


def start(city: Path, words: Sequence[str]) -> subprocess.Popen[bytes]:
    """Start a build."""
    models = ["--models", str(city.parent / "models")]
    command = [sys.executable, "-m", "pipelines.cli", "build", str(city), *models]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    return subprocess.Popen([*command, *words], **quiet)


def ended(*processes: subprocess.Popen[bytes]) -> None:
    """Wait for builds."""
    for process in processes:
        process.wait()


def disturbed(city: Path, kind: str, after: float, rng: np.random.Generator) -> None:
    """Build, and kill somebody after so many seconds."""
    if kind == "shard":
        both = [start(city, (f"--shard={k}/2",)) for k in (1, 2)]
        time.sleep(after)
        both[rng.integers(2)].kill()
        ended(*both)
        return
    driver = start(city, (WORKERS,))
    time.sleep(after)
    victims = descendants(driver.pid) if kind == "worker" else []
    victim = int(rng.choice(sorted(victims))) if victims else driver.pid
    with contextlib.suppress(ProcessLookupError):
        os.kill(victim, signal.SIGKILL)
    try:
        driver.wait(timeout=120)
    except subprocess.TimeoutExpired:  # Beam waits for a worker that is no more
        driver.kill()
        driver.wait()


def descendants(process: int) -> list[int]:
    """List the processes below one that run Python, as /proc knows them."""
    children = defaultdict(list)
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            head, _, rest = path.read_text().rpartition(")")
        except OSError:
            continue
        if "python" in head:
            children[int(rest.split()[1])].append(int(head.split()[0]))
    found, waiting = [], [process]
    while waiting:
        own = children[waiting.pop()]
        found += own
        waiting += own
    return found


def outcome(city: Path, whole: dict[str, str]) -> tuple[bool, int, int, int]:
    """Build to the end, and tell what came of it."""
    there = {path: path.stat().st_mtime_ns for path in artifacts(city, "")}
    ended(start(city, ()))
    after = {path: path.stat().st_mtime_ns for path in artifacts(city, "")}
    again = sum(after[path] != when for path, when in there.items())
    found = {name: sha for name, sha in tree(city).items() if "aside" not in name}
    same = all(found.get(name) == sha for name, sha in whole.items())
    return same, len(there), len(after) - len(there) + again, again


if __name__ == "__main__":
    main(int(sys.argv[1]) if sys.argv[1:] else 51)
