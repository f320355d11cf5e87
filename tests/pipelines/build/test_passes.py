"""Work that is done in passes comes to what one pipeline does, in bounded pieces."""

import json
import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from apache_beam.options.pipeline_options import PipelineOptions

from pipelines import build, stopping
from pipelines.build import passes
from pipelines.build.launched import launched
from pipelines.build.passes import dealt, together, worked
from pipelines.index import asked, manifest, source
from pipelines.index.asked import Asked
from pipelines.reprocess import reprocess
from pipelines.store import Store, runs
from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, copied, tree

RNG = np.random.default_rng(0)


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A painted city of two blocks that was built by one pipeline."""
    city = painted.write_city(tmp_path_factory.mktemp("painted"))
    built(city)
    return city


def counted(monkeypatch: pytest.MonkeyPatch, rows: int, *, die_at: int = 0) -> list:
    """Let passes be of so few rows, count them, and end a run before one of them."""
    ran: list[int] = []

    def count(*told: Any) -> Any:
        ran.append(1)
        if len(ran) == die_at:
            raise stopping.Stopped("it was asked to end", 143)
        return launched(*told)

    monkeypatch.setattr(passes, "ROWS", rows)
    monkeypatch.setattr(passes, "launched", count)
    return ran


def stages(city: Path) -> dict[str, Any]:
    run = (city / "CURRENT").read_text().strip()
    return json.loads((city / "runs" / run / "run.json").read_text())["stages"]


@pytest.mark.parametrize("workers", [1, 2])
def test_passes_write_the_bytes_that_one_pipeline_writes_and_count_alike(
    city: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, workers: int
) -> None:
    other = copied(city, tmp_path)
    ran = counted(monkeypatch, 1)
    built(other, [f"--direct_num_workers={workers}"])
    assert len(ran) == 2
    assert tree(other) == tree(city)
    for stage, told in stages(city).items():
        assert stages(other)[stage]["made"] == told["made"], stage


def test_a_run_of_few_rows_is_one_pipeline(
    city: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = copied(city, tmp_path)
    ran = counted(monkeypatch, 100)
    built(other)
    assert len(ran) == 1


def test_a_run_that_ends_before_its_second_pass_goes_on_there(
    city: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = copied(city, tmp_path)
    with monkeypatch.context() as patch:
        counted(patch, 1, die_at=2)
        with pytest.raises(stopping.Stopped):
            built(other)
    assert not (other / "CURRENT").exists()
    made = {path: path.stat().st_mtime_ns for path in artifacts(other, "")}
    assert 0 < len(made) < len(artifacts(city, ""))
    counted(monkeypatch, 1)
    built(other)
    assert {path: path.stat().st_mtime_ns for path in made} == made
    assert tree(other) == tree(city)


def test_what_is_stale_is_redone_in_passes_and_nothing_is_launched_without_any(
    city: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(city.parent, tmp_path / "painted")
    other = tmp_path / "painted" / city.name
    for path in artifacts(other, "inpaint"):
        path.unlink()
    options = build.options(str(other), models=str(other.parent / "models"))
    ran = counted(monkeypatch, 1)
    assert reprocess(options).report
    assert len(ran) == 2
    assert tree(other) == tree(city)
    assert reprocess(options).report is None
    assert len(ran) == 2


def asked_of(folder: Path, pairs: list[tuple[str, str]]) -> tuple[Store, Asked]:
    """Ask for rows, each a photo that may show a front of a block."""
    store = Store(str(folder))
    rows = pq.read_table(folder / manifest.PARQUET).to_pylist()
    one = next(row for row in rows if row["photo"])
    told = [
        one | {"photo": p, "block": b, "front_id": f"{b}-{n}", "rank": n}
        for n, (p, b) in enumerate(pairs)
    ]
    manifest.write(store, told)
    return store, asked.ask(store, source.found(store), "run")


def test_each_row_is_of_one_pass_and_no_photo_or_block_is_of_two(
    city: Path, tmp_path: Path
) -> None:
    other = copied(city, tmp_path)
    pairs = [(f"{i}.jpg", f"{i // 5}") for i in range(60)]
    pairs += [("0.jpg", "7"), ("12.jpg", "9"), ("", "3"), ("nowhere.jpg", "")]
    store, todo = asked_of(other, pairs)
    seen: list[tuple[int, str, str]] = []
    refused = []
    for number, one in enumerate(passes.passes(store, todo, 12)):
        found = list(asked.rows(store, one.run))
        assert one.rows == len(found)
        assert one.rows <= 12 + len(refused)
        for row in found:
            if isinstance(row, asked.Row):
                seen.append((number, row.photo, asked.block_of(row)))
            else:
                refused.append(number)
    assert refused == [0]
    assert sorted((p, b) for _, p, b in seen) == sorted((p, b) for p, b in pairs if b)
    for at in (1, 2):
        of = {(row[at], row[0]) for row in seen if row[at]}
        assert len(of) == len({name for name, _ in of})


def test_what_belongs_together_goes_together_however_much_it_is() -> None:
    for _ in range(20):
        photos = RNG.integers(1, 60, 80).astype(np.uint64)
        blocks = RNG.integers(100, 130, 80).astype(np.uint64)
        nodes, labels = together(photos, blocks)
        of_row = labels[np.searchsorted(nodes, blocks)]
        assert (of_row == labels[np.searchsorted(nodes, photos)]).all()
        which = dealt(of_row, 10)
        for group in np.unique(of_row):
            assert len(np.unique(which[of_row == group])) == 1
        sizes = np.bincount(which)
        assert sizes.min() > 0
        alone = [len(np.unique(of_row[which == n])) == 1 for n in range(len(sizes))]
        assert all(one or size <= 10 for one, size in zip(alone, sizes, strict=True))


def test_other_runners_have_one_pipeline(
    city: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(passes, "ROWS", 1)
    monkeypatch.setattr(passes, "launched", lambda *_: None)
    store, todo = asked_of(copied(city, tmp_path), [("a.jpg", "1"), ("b.jpg", "2")])
    options = PipelineOptions(["--runner=PrismRunner"])
    assert len(worked(options, lambda *_: None, store, todo)) == 1
    assert not store.names(f"runs/{todo.run}/{runs.PASSES}")


@pytest.mark.parametrize("workers", [1, 2])
def test_a_pipeline_that_raises_leaves_no_folder_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, workers: int
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))

    def raising(_: object) -> None:
        raise ValueError("not wired")

    options = build.options("city", beam=[f"--direct_num_workers={workers}"])
    with pytest.raises(ValueError, match="not wired"):
        launched(options, raising, Store(str(tmp_path / "city")))
    assert not list(tmp_path.glob("beam-*"))
