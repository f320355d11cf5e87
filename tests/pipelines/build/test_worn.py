"""A front's worker reads elevations of its few photographs, and fills one of them."""

import json
from pathlib import Path

import numpy as np
import pyarrow as pa
import pytest

from nostalgin_core import evidence, rests
from nostalgin_core.records import (
    Box,
    Elevation,
    Facade,
    Matted,
    Photo,
    Rejection,
    Seen,
    Standpoint,
)
from pipelines.build import artifacts
from pipelines.build.bench import Bench
from pipelines.build.stages import FacadeRef
from pipelines.build.worn import Worn, borrowed
from pipelines.index.plan import PhotoRef
from pipelines.models import Models
from pipelines.store import Store, tables
from pipelines.store.versions import Versions
from tests.core.borrow.test_borrow import (
    CAR,
    OTHER_CAR,
    behind,
    elevation,
    lender,
    wall,
)

VERSIONS = Versions("s", "m", "r", "i", "b", "t", "w")


def facade(folder: Path, name: str, view: Elevation) -> FacadeRef:
    """Leave an elevation in the store, as `rectify` does."""
    seen = Seen(name, 0, bool(name), 0.9, 0.9, view.aspect, 0.1, 50.0, 9e4, 0.9)
    stood = Standpoint(
        size_px=(300, 420),
        photo_from_camera=np.eye(3),
        focal_sd=0.1,
        position=(0.5, 0.2, 2.0),
        position_sd=0.1,
        front_from_camera=np.eye(3),
        quad_px=view.quad,
        roof=1.4,
    )
    row = tables.to_row(view) | tables.to_row(seen) | tables.to_row(stood)
    table = pa.Table.from_pylist([row], artifacts.RECTIFIED)
    store = Store(str(folder))
    store.keep(VERSIONS.path("rectify", VERSIONS.rectify_key(name)), table)
    ref = PhotoRef(str(folder / "photos"), f"{name}.jpg", ("1",), name)
    return FacadeRef(ref, seen, stood)


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    return Bench(Store(str(tmp_path)), VERSIONS, Models(str(tmp_path)))


@pytest.fixture
def front(tmp_path: Path) -> Worn:
    own = facade(tmp_path, "own", elevation(wall(1), behind(CAR)))
    first = facade(tmp_path, "first", lender("first", wall(1), OTHER_CAR).view)
    second = facade(tmp_path, "second", lender("second", wall(2), OTHER_CAR).view)
    return Worn(own, "1-1-0", (first, second))


def artifact(folder: Path) -> Path:
    (path,) = (folder / "artifacts" / "borrow").rglob("*.parquet")
    return path


def test_what_was_lent_is_kept_and_told(
    front: Worn, bench: Bench, tmp_path: Path
) -> None:
    made = borrowed(front, bench)
    assert made.lent is not None
    assert made.lent.photos == ("first",)
    assert made.lent.left < 0.05 * made.lent.unseen
    rows = bench.store.read_table(artifact(tmp_path).relative_to(tmp_path).as_posix())
    view = tables.records(Elevation, rows)[0]
    sources = tables.from_png(rows.to_pylist()[0]["sources"])
    assert np.array_equal(sources == 1, view.evidence == rests.ANOTHER)
    assert not (view.evidence == evidence.INPAINTED)[340:410, 70:180].any()


def test_a_second_run_finds_what_the_first_made(
    front: Worn, bench: Bench, tmp_path: Path
) -> None:
    first = borrowed(front, bench)
    path = artifact(tmp_path)
    bytes_, when = path.read_bytes(), path.stat().st_mtime_ns
    assert borrowed(front, bench) == first
    assert path.stat().st_mtime_ns == when
    path.unlink()
    assert borrowed(front, bench) == first
    assert path.read_bytes() == bytes_


def test_a_front_whose_lender_cannot_be_read_now_is_made_by_the_next_run(
    front: Worn, bench: Bench, tmp_path: Path
) -> None:
    key = VERSIONS.rectify_key("second")
    lost = tmp_path / VERSIONS.path("rectify", key)
    data = lost.read_bytes()
    lost.write_bytes(data[:200])
    with pytest.raises(FileNotFoundError):  # its photograph, to make it again
        borrowed(front, bench)
    assert not (tmp_path / "artifacts" / "borrow").exists()
    lost.write_bytes(data)
    made = borrowed(front, bench)
    assert made.lent is not None
    fits = json.loads(made.lent.fits)
    assert [(one["photo"], one["fits"]) for one in fits] == [
        ("first", True),
        ("second", False),
    ]


def test_a_front_that_nobody_else_shows_leaves_nothing(
    front: Worn, bench: Bench, tmp_path: Path
) -> None:
    alone = Worn(front.own, front.front_id)
    assert borrowed(alone, bench) is alone
    assert not (tmp_path / "artifacts" / "borrow").exists()
    assert alone.inpaint_key(VERSIONS) == VERSIONS.inpaint_key("own", 0)
    assert front.inpaint_key(VERSIONS) != alone.inpaint_key(VERSIONS)


def test_words_of_a_watermark_go_with_the_facade_it_was_taken_out_of() -> None:
    view = elevation(wall(1), behind(CAR))
    picture = Photo("k", view.image, Box(0, 0, *view.image.shape[::-1]))
    mask = np.ones(view.image.shape, bool)
    one = Facade(0, 0.9, True, 0.9, mask, mask, mask.astype(np.float32))  # noqa: FBT003
    for words in ("", "A.org/records"):
        table = artifacts.rectified_table(picture, Matted((one,), ()), (view,), words)
        (seen,) = artifacts.seen_from(table)
        assert not isinstance(seen, Rejection)
        assert seen[2] == words
