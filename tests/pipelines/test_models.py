import os
import subprocess
import sys

REPORT = """
import numpy, scipy.linalg, threadpoolctl
before = max(one["num_threads"] for one in threadpoolctl.threadpool_info())
{limit}
after = max(one["num_threads"] for one in threadpoolctl.threadpool_info())
print(before, after)
"""
LIMIT = "from pipelines.models import one_thread; one_thread()"


def threads(limit: str) -> list[int]:
    """Count the threads of libraries that were loaded before, and after a limit."""
    told = {"OMP_NUM_THREADS": "2", "OPENBLAS_NUM_THREADS": "2"}
    command = [sys.executable, "-c", REPORT.format(limit=limit)]
    output = subprocess.check_output(command, text=True, env=os.environ | told)
    return [int(word) for word in output.split()]


def test_libraries_that_are_loaded_already_are_kept_to_one_thread() -> None:
    assert threads(LIMIT)[1] == 1


def test_this_check_can_fail() -> None:
    before, after = threads("")
    assert before == after
    assert before > 1 or os.cpu_count() == 1
