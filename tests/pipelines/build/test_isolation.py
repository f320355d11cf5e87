"""Whatever becomes of a process that does a stage's work, the others go on."""

import ctypes
import os
import pickle
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
import threadpoolctl

from nostalgin_core.records import Rejection
from pipelines.build.isolation import POOL, Crashed, Isolation
from pipelines.build.supervisor import Limits
from pipelines.models import Models
from pipelines.store import Aside, Store, Unstored
from pipelines.store.versions import Versions

VERSIONS = Versions.present(Models())
LIMITS = Limits(seconds=20, gigabytes=1.5)


def eat(_: object) -> None:
    kept = []
    while True:
        kept.append(np.empty(1 << 27))  # what is asked for counts, used or not


def unstored(_: object) -> None:
    raise Unstored("the disk is full")


DEADLY: dict[str, Any] = {
    "abort": lambda _: os.abort(),
    "exit": lambda _: sys.exit(7),
    "leave": lambda _: os._exit(9),
    "kill": lambda _: os.kill(os.getpid(), signal.SIGKILL),
    "segfault": lambda _: ctypes.string_at(0),
    "end the supervisor": lambda _: os.kill(os.getppid(), signal.SIGKILL),
}
HOW = {"abort": "SIGABRT", "exit": "exit code 7", "kill": "SIGKILL"}
OTHERS: dict[str, Any] = {
    "sleep": lambda _: time.sleep(60),
    "eat": eat,
    "divide": lambda one: 1 / int(not one),
    "store": unstored,
}


def act(element: str) -> str:
    """Do what an element says; say it back if it means no harm."""
    return {**DEADLY, **OTHERS}.get(element, str)(element) or element


ACT = pickle.dumps(act)


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return Store(str(tmp_path))


def isolation(
    store: Store, limits: Limits = LIMITS, *, retry: bool = False
) -> Isolation:
    return Isolation(limits, Aside(store, VERSIONS, retry))


def done(one: Isolation, element: Any, act: bytes = ACT) -> Any:
    return one.done(act, element, stage="matte", key="photo.jpg").result


@pytest.mark.parametrize("deadly", DEADLY)
def test_what_kills_its_process_twice_is_put_aside_and_others_go_on(
    deadly: str, store: Store
) -> None:
    why = done(isolation(store), deadly)
    assert (why.key, why.stage, why.reason) == ("photo.jpg", "matte", "put aside")
    assert f"2 times ({HOW.get(deadly, '')}" in why.detail
    assert "--retry" in why.detail
    assert done(isolation(store), "harmless") == "harmless"


def test_what_never_ends_is_ended(store: Store) -> None:
    why = done(isolation(store, Limits(0.2, 1.5)), "sleep")
    assert "more than 0.2 s" in why.detail


def nap(group: Any) -> str:
    """Sleep for as long as a group is allowed to, and an element of its own is not."""
    name, parts = group
    time.sleep(0.1 * len(parts["facades"]))
    return name


def test_a_group_may_take_longer_the_more_members_it_has(store: Store) -> None:
    limits, act = Limits(3.0, 1.5), pickle.dumps(nap)
    large = ("large", {"task": ["block"], "facades": ["one"] * 40})
    assert done(isolation(store, limits), large, act) == "large"


def test_memory_has_a_limit_and_the_next_finds_it_free_again(store: Store) -> None:
    one = isolation(store)
    with pytest.raises(Crashed, match=r"MemoryError: .* more than 1\.5 GB"):
        done(one, "eat")
    assert done(one, "harmless") == "harmless"


def test_an_exception_comes_back_as_its_text(store: Store) -> None:
    with pytest.raises(Crashed) as raised:
        done(isolation(store), "divide")
    assert repr(raised.value) == "ZeroDivisionError('division by zero')"


def test_what_ends_the_run_ends_it_from_another_process_too(store: Store) -> None:
    with pytest.raises(Unstored, match="the disk is full"):
        done(isolation(store), "store")


def count(path: str) -> int:
    """Count its calls in a file, and die in the first two."""
    with Path(path).open("a") as file:
        file.write("x")
    calls = len(Path(path).read_text())
    if calls <= 2:
        os.abort()
    return calls


def test_what_was_put_aside_is_not_tried_again_unless_asked(
    store: Store, tmp_path: Path
) -> None:
    calls, act = tmp_path / "calls", pickle.dumps(count)
    first = done(isolation(store), str(calls), act)
    assert isinstance(first, Rejection)
    assert done(isolation(store), str(calls), act) == first
    assert calls.read_text() == "xx"
    assert done(isolation(store, retry=True), str(calls), act) == 3
    assert done(isolation(store), str(calls), act) == 4  # which is no longer known


def test_a_death_that_was_another_s_fault_costs_nothing(
    store: Store, tmp_path: Path
) -> None:
    calls = tmp_path / "calls"
    calls.write_text("x")
    assert done(isolation(store), str(calls), pickle.dumps(count)) == 3


def test_a_group_is_known_again_in_whatever_order_it_comes(store: Store) -> None:
    aside = Aside(store, VERSIONS)
    aside.put(
        "block", ("993", {"facades": ["a", "b"]}), Rejection("993", "b", "r", "d")
    )
    again = Aside(store, VERSIONS)
    assert again.of("block", ("993", {"facades": ["b", "a"]})) is not None
    assert again.of("block", ("993", {"facades": ["b"]})) is None
    assert again.of("assign", ("993", {"facades": ["a", "b"]})) is None


def here(_: object) -> tuple[int, int]:
    return os.getpid(), os.getppid()


def test_a_process_serves_many_elements(store: Store) -> None:
    act, one = pickle.dumps(here), isolation(store)
    assert done(one, "1", act) == done(one, "2", act)


def threads(_: object) -> int:
    known = threadpoolctl.threadpool_info()
    return max(cv2.getNumThreads(), *(one["num_threads"] for one in known))


def test_a_process_keeps_its_libraries_to_one_thread_whoever_it_is_of(
    store: Store,
) -> None:
    POOL.end()
    before = cv2.getNumThreads()
    cv2.setNumThreads(2)
    found = done(isolation(store), "1", pickle.dumps(threads))
    cv2.setNumThreads(before)
    POOL.end()
    assert found == 1


@pytest.mark.parametrize("others", [0, 1])
def test_nobody_is_left_when_the_worker_is_gone(others: int, store: Store) -> None:
    stop = threading.Event()
    threads = [threading.Thread(target=stop.wait) for _ in range(others)]
    for thread in threads:  # with one, the supervisor is started and not forked
        thread.start()
    POOL.end()
    processes = done(isolation(store), "1", pickle.dumps(here))
    POOL.end()
    stop.set()
    deadline = time.monotonic() + 20
    while any(map(alive, processes)) and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not any(map(alive, processes))


def alive(process: int) -> bool:
    """Tell whether a process runs; one that waits to be buried does not."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        return False
    return state != "Z"


def folder(_: object) -> str:
    return str(Path.cwd())


def test_relative_paths_begin_where_they_do_for_the_worker(
    store: Store, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    act = pickle.dumps(folder)
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        monkeypatch.chdir(tmp_path / name)
        assert done(isolation(store), name, act) == str(tmp_path / name)
