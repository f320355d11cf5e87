"""What a build costs, beside the plain loop over the same painted photos.

    python tests/bench/bench_build.py [photos, default 8] [workers, default 1]

CPU seconds count (a busy machine stretches the clock, not these), peak memory is the
largest process's. The networks are the shipped ones.
"""

import resource
import sys
import tempfile
import time
from pathlib import Path

from rich.console import Console

from nostalgin_core import steps
from pipelines.build.build import build
from pipelines.build.options import options
from pipelines.console.hush import hushed
from pipelines.demo import painted
from pipelines.index.index import index
from pipelines.models import Models, one_thread

KIB = 1024


def cpu_seconds() -> float:
    """Add up what this process and its ended children used."""
    both = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    used = [resource.getrusage(who) for who in both]
    return sum(one.ru_utime + one.ru_stime for one in used)


def peak_gb() -> float:
    """Tell the most memory that one process held."""
    both = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return max(resource.getrusage(who).ru_maxrss for who in both) * KIB / 1e9


def main(count: int, workers: int) -> None:
    """Build a painted archive, then run the plain loop, and print both costs."""
    one_thread()
    with tempfile.TemporaryDirectory() as folder:
        city = Path(folder)
        photos, listed = painted(city, blocks=1, tell=lambda *_: None)
        kept = sorted(photos.iterdir())[:count]
        for path in set(photos.iterdir()) - set(kept):
            path.unlink()
        index(photos, listed, folder)
        console = Console(stderr=True)
        cpu, wall = cpu_seconds(), time.perf_counter()
        with hushed(console):
            beam = [f"--direct_num_workers={workers}"]
            build(options(folder, beam=beam))
        cpu, wall = cpu_seconds() - cpu, time.perf_counter() - wall
        rate = 60 * len(kept) / wall
        print(f"build  {len(kept)} photos, {workers} workers: {cpu:.1f} CPU s")
        print(f"       {rate:.1f} photos a minute, peak {peak_gb():.2f} GB")
        before = cpu_seconds()
        networks = Models().networks(placard=False)
        for path in kept:
            steps.photograph(path.read_bytes(), networks, name=path.name)
        loop = cpu_seconds() - before
        print(f"loop   {loop:.1f} CPU s, every facade inpainted")
        print(f"build / loop: {cpu / loop:.2f}")


if __name__ == "__main__":
    numbers = [int(word) for word in sys.argv[1:]]
    main(*[*numbers, *[8, 1][len(numbers) :]])
