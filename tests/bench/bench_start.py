"""What the start of a run's process costs: imports and both networks, in CPU seconds.

Baseline: a process that loads Beam alone, and one that loads Beam as it loads itself.

    OMP_NUM_THREADS=1 python tests/bench/bench_start.py
"""

import statistics
import subprocess
import sys

TIMES = 3
LEAN = "import pipelines.build.lean"
WORKER = "import pipelines.build.blocks, apache_beam.runners.worker.sdk_worker_main"
NETWORKS = (
    "from pipelines.models import Models, one_thread; one_thread(); "
    "m = Models(); m.load('segment'); m.load('inpaint')"
)
STARTS = {
    "Beam alone": "import apache_beam.runners.worker.sdk_worker_main",
    "Beam, lean": f"{LEAN}; import apache_beam.runners.worker.sdk_worker_main",
    "a worker": WORKER,
    "a worker and its networks": f"{WORKER}; {NETWORKS}",
}


def cpu_seconds(statement: str) -> float:
    """Run a statement in a fresh interpreter, and tell what that took."""
    known = f"{statement}; import time; print(time.process_time())"
    said = subprocess.check_output([sys.executable, "-c", known], text=True)
    return float(said)


def main() -> None:
    """Measure each start in turn, and again: a machine is not equally loaded."""
    taken: dict[str, list[float]] = {name: [] for name in STARTS}
    for _ in range(TIMES):
        for name, statement in STARTS.items():
            taken[name].append(cpu_seconds(statement))
    baseline = statistics.median(taken["Beam alone"])
    for name, times in taken.items():
        median = statistics.median(times)
        print(f"{name:28}{median:6.2f} CPU s {median / baseline:6.2f} of Beam alone")


if __name__ == "__main__":
    main()
