import os
import subprocess
import sys
from pathlib import Path

import pytest

from pipelines.store import Busy, Store, held
from pipelines.store.lock import LOCK

HOLD = """
import sys
from pipelines.store import Store, held
with held(Store(sys.argv[1]), shared=sys.argv[2] == "shared"):
    print("held", flush=True)
    sys.stdin.read()
"""


class Other:
    """Another process that holds the lock."""

    def __init__(self, folder: Path, *, shared: bool) -> None:
        words = [sys.executable, "-c", HOLD, str(folder), "shared" * shared]
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
        self.process = subprocess.Popen(words, text=True, **pipes)
        assert self.process.stdout is not None
        assert self.process.stdout.readline() == "held\n"

    def kill(self) -> None:
        self.process.kill()
        self.process.communicate()


@pytest.mark.parametrize(
    ("theirs", "mine"), [(False, False), (False, True), (True, False)]
)
def test_a_second_run_is_refused_and_told_who_is_at_work(
    tmp_path: Path, *, theirs: bool, mine: bool
) -> None:
    other = Other(tmp_path, shared=theirs)
    said = rf"process {other.process.pid} on .* since 20.*: wait"
    with pytest.raises(Busy, match=said), held(Store(str(tmp_path)), shared=mine):
        pytest.fail("two at once")
    other.kill()


def test_shards_work_side_by_side(tmp_path: Path) -> None:
    other = Other(tmp_path, shared=True)
    with held(Store(str(tmp_path)), shared=True):
        pass
    other.kill()


def test_a_crash_leaves_no_lock(tmp_path: Path) -> None:
    Other(tmp_path, shared=False).kill()
    assert (tmp_path / LOCK).read_bytes()  # its word is left, and binds nobody
    with held(Store(str(tmp_path))):
        assert str(os.getpid()) in (tmp_path / LOCK).read_text()
    assert (tmp_path / LOCK).read_bytes() == b""


def test_a_lock_is_not_taken_through_a_link(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("mine")
    (tmp_path / LOCK).symlink_to(tmp_path / "mine")
    with pytest.raises(OSError), held(Store(str(tmp_path))):  # noqa: PT011
        pytest.fail("followed")
    assert (tmp_path / "mine").read_text() == "mine"


def test_what_is_elsewhere_is_not_locked() -> None:
    with held(Store("s3://bucket/city")):
        pass
