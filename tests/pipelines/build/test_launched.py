"""What ends a run is told by its cause: no room, no leave, or something else."""

import errno
import os

import pytest

from pipelines.build.launched import unwritten

TRACE = 'Traceback (most recent call last):\n  File "x.py", line 1\n'


@pytest.mark.parametrize("name", ["ENOSPC", "EDQUOT", "EROFS", "EACCES", "ENOTDIR"])
def test_a_folder_that_takes_no_more_is_told(name: str) -> None:
    number = getattr(errno, name)
    line = f"[Errno {number}] {os.strerror(number)}: 'city/runs/1/photos.parquet'"
    problem = type(OSError(number, "")).__name__
    assert unwritten(f"{TRACE}{problem}: {line}\n") == line


def test_an_artifact_that_could_not_be_kept_is_told_whatever_the_cause() -> None:
    text = f"{TRACE}pipelines.store.store.Unstored: AWS Error ACCESS_DENIED\n"
    assert unwritten(text) == "AWS Error ACCESS_DENIED"


@pytest.mark.parametrize(
    "line",
    [
        "OSError: [Errno 5] Input/output error: 'photos/1.png'",
        "OSError: [Errno 24] Too many open files",
        "ConnectionResetError: [Errno 104] Connection reset by peer",
        "FileNotFoundError: [Errno 2] No such file or directory: 'asked.parquet'",
        "OSError: Couldn't deserialize thrift: bad header",
        "ValueError: nothing of the kind",
    ],
)
def test_of_other_troubles_nobody_is_told_to_make_room(line: str) -> None:
    assert unwritten(f"{TRACE}{line}\n") == ""
