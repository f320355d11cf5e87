import errno
from pathlib import Path

import pytest

from pipelines import bounded
from pipelines.store import Store
from tests.pipelines.hostile import hostile


@pytest.mark.parametrize("kind", ["pipe", "device", "holes"])
@pytest.mark.parametrize("prefix", ["", "file://"])
def test_what_has_no_end_is_refused(tmp_path: Path, kind: str, prefix: str) -> None:
    hostile(tmp_path / "file", kind)
    with pytest.raises(OSError, match=r"Not a regular file|Larger than the 100 bytes"):
        bounded.read(tmp_path / "file", 100)
    with pytest.raises(OSError, match=r"Not a regular file|Larger than the 100 bytes"):
        Store(f"{prefix}{tmp_path}").read_bytes("file", 100)


@pytest.mark.parametrize("size", [0, 1, 99, 100])
def test_a_file_is_read_up_to_the_limit_and_not_beyond(
    tmp_path: Path, size: int
) -> None:
    data = bytes(range(size))
    (tmp_path / "file").write_bytes(data)
    assert bounded.read(tmp_path / "file", 100) == data
    (tmp_path / "file").write_bytes(bytes(101))
    with pytest.raises(OSError, match="Larger") as refused:
        bounded.read(tmp_path / "file", 100)
    assert refused.value.errno == errno.EFBIG


def test_a_file_that_tells_no_size_is_bounded_all_the_same() -> None:
    path = Path("/proc/self/smaps")
    if not path.exists():
        pytest.skip("this system has no such files")
    assert path.stat().st_size == 0
    with pytest.raises(OSError, match="Larger"):
        bounded.read(path, 100)


def test_a_folder_is_told_as_one(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError):
        bounded.read(tmp_path, 100)
