"""Workers are forked from a process that has loaded all, and told apart from it."""

import subprocess
import sys

import pytest

from tests.data import ROOT

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="nothing is forked")

# A worker is what `worker.work` is; here it tells or does what its environment says.
BEGIN = """
import os, signal, sys, threading, time
from pipelines.build import worker
from pipelines.build.isolation import POOL
from pipelines.build.mould import MOULD
def work():
    exec(os.environ["WORK"])
worker.work = work
os.environ["KEPT"] = "by the owner"
MOULD.fill()
def done(work, **more):
    return MOULD.start({"WORK": work, **more})
"""


def ran(then: str) -> str:
    """Fork workers in a fresh process, which has no threads, and hear what it says."""
    done = subprocess.run(
        [sys.executable, "-c", BEGIN + then],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    return done.stdout + done.stderr


def test_how_a_worker_ended_is_told() -> None:
    said = ran(
        'print(done("pass").wait(), done("sys.exit(3)").wait() != 0, '
        'done("os.kill(os.getpid(), 9)").wait())'
    )
    assert said.split() == ["0", "True", "-9"]


def test_a_worker_has_the_environment_that_it_is_given_and_no_other() -> None:
    words = 'print(os.environ.get("KEPT"), os.environ["MORE"], os.getcwd(), flush=True)'
    said = ran(f"os.chdir('/')\ndone({words!r}, MORE='told').wait()")
    assert said.split() == ["None", "told", "/"]


def test_a_worker_ends_when_it_is_asked_to_and_others_go_on() -> None:
    said = ran(
        "one, other = done('time.sleep(60)'), done('time.sleep(1)')\n"
        "try: one.wait(0.1)\n"
        "except Exception as problem: print(type(problem).__name__)\n"
        "one.terminate(); print(one.wait(), one.poll()); one.kill()\n"
        "print(other.wait())"
    )
    assert said.split() == ["TimeoutExpired", "-15", "-15", "0"]


def test_a_worker_whose_owner_is_gone_is_ended() -> None:
    said = ran(
        "one = done('print(os.getpid(), flush=True); time.sleep(60)')\n"
        "time.sleep(1)\n"
        "one._connection.close()\n"
        "time.sleep(0.5)"
    )
    process = said.split()[0]
    assert subprocess.run(["kill", "-0", process], check=False).returncode != 0


def test_a_worker_tells_the_runner_its_own_name() -> None:
    of = "apache_beam.runners.worker.worker_id_interceptor"
    words = f"import {of} as one; print(one.WorkerIdInterceptor()._worker_id)"
    words = f"{words}; sys.stdout.flush()"
    said = ran(f"for name in ('7', '8'): done({words!r}, WORKER_ID=name).wait()")
    assert said.split() == ["7", "8"]


def test_a_worker_has_supervisors_of_its_own() -> None:
    said = ran("done('print(POOL._free, flush=True)').wait()")
    assert said.split() == ["[]"]


def test_what_a_worker_and_its_supervisor_spend_counts_as_the_owner_s() -> None:
    words = (
        "import pickle; from pipelines.build.supervisor import Limits\n"
        "with POOL.one() as one: one.ask(pickle.dumps(sum), range(10**8), Limits())"
    )
    said = ran(
        f"done({words!r}).wait(); before = os.times().children_user\n"
        "MOULD.end(); print(os.times().children_user - before)"
    )
    assert float(said) > 0.5


def test_with_threads_nothing_is_forked() -> None:
    said = ran(
        "MOULD.end()\n"
        "stop = threading.Event()\n"
        "threading.Thread(target=stop.wait).start()\n"
        "MOULD.fill(); print(MOULD.ready); stop.set()"
    )
    assert said.split() == ["False"]
