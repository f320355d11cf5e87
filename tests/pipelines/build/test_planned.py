"""What a run is asked for reaches the pipeline in pieces, and no row in its graph."""

from dataclasses import replace
from pathlib import Path

import apache_beam as beam
import numpy as np
import pytest
from apache_beam.testing import test_pipeline
from apache_beam.testing.util import assert_that, equal_to

from nostalgin_core.records import Front, Rejection
from pipelines.build.bench import Bench
from pipelines.build.build import write
from pipelines.build.city import city
from pipelines.build.planned import Plan
from pipelines.build.stages import read
from pipelines.index import asked, manifest, source
from pipelines.index.asked import Asked, ask
from pipelines.index.plan import PhotoRef, plan
from pipelines.models import Models
from pipelines.reprocess.reprocess import written
from pipelines.store import Store, runs
from pipelines.store.versions import Versions

FRONT = Front("1-1-0", "1", "1", 0, 0, 0, "Elm Street", "1", 8.0, None, False)  # noqa: FBT003
ROWS = 720_000
MOST_BYTES = 1_000_000


@pytest.fixture
def store(tmp_path: Path) -> Store:
    return Store(str(tmp_path / "city"))


def listed(store: Store, blocks: int) -> None:
    """Write a manifest of blocks of three fronts, some shown twice, one homeless."""
    rows = []
    for number in range(3 * blocks):
        block, rank = divmod(number, 3)
        front = replace(FRONT, front_id=f"{block}-{rank}", block=str(block), rank=rank)
        names = [f"{number}.jpg", f"{max(0, number - 3)}.jpg"] if rank else [""]
        rows += [manifest.row_of(n, front, root="photos", credit="") for n in names]
    rows.append(manifest.row_of("stray.jpg", None, root="photos", credit=""))
    manifest.write(
        store, [rows[n] for n in np.random.default_rng(7).permutation(len(rows))]
    )


@pytest.mark.parametrize("shard", [(1, 1), (2, 3)])
def test_the_pipeline_plans_what_the_plain_loop_plans(
    store: Store, shard: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(asked, "GROUP", 16)
    listed(store, 40)
    todo = ask(store, source.found(store), "run", shard=shard)
    oracle = plan(manifest.read(store).rows, city=store.root, shard=shard)
    assert len(todo.pieces()) > 3
    assert (todo.photos, todo.blocks) == (len(oracle.photos), len(oracle.blocks))
    with test_pipeline.TestPipeline(runner="FnApiRunner") as pipeline:
        made = pipeline | Plan(store, todo)
        blocks = made.blocks | beam.Values()
        assert_that(made.photos, equal_to(oracle.photos), "photos")
        assert_that(blocks, equal_to(oracle.blocks), "blocks")
        assert_that(made.rejections, equal_to(oracle.rejections), "rejections")


def test_what_is_asked_is_read_back_in_pieces(
    store: Store, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(asked, "GROUP", 10)
    monkeypatch.setattr(asked, "PIECES", 4)
    listed(store, 20)
    todo = ask(store, source.found(store), "run")
    whole = list(asked.rows(store, "run"))
    parts = [list(asked.rows(store, "run", piece)) for piece in todo.pieces()]
    assert len(parts) == 4
    assert [one for part in parts for one in part] == whole
    usable = [one for one in whole if not isinstance(one, Rejection)]
    assert usable == list(manifest.read(store).rows[:-1])


def test_photos_that_only_unusable_rows_name_are_counted_once(store: Store) -> None:
    """Of `stray.jpg`, of a row with a width that is none, and of a photo with both."""
    listed(store, 1)
    table = (Path(store.root) / manifest.CSV).read_text()
    placed = next(line for line in table.split("\n") if ",2.jpg," in line)
    spoiled = placed.replace(",8.0,", ",abc,")
    added = [spoiled, *2 * [spoiled.replace(",2.jpg,", ",other.jpg,")]]
    stray = "photos,stray.jpg" + "," * (table.split("\n")[0].count(",") - 1)
    text = table.rstrip() + "\n" + "\n".join([*added, stray]) + "\n"
    (Path(store.root) / manifest.CSV).write_text(text)
    todo = ask(store, source.found(store), "run")
    assert (todo.photos, todo.unplaced) == (3, 2)
    refused = [r for r in asked.rows(store, "run") if isinstance(r, Rejection)]
    assert len(refused) == 5
    groups = store.read_groups(runs.table_path("run", asked.ASKED))
    again = written(store, "again", groups, "")
    assert (again.photos, again.unplaced) == (3, 2)


def test_photos_of_a_folder_that_is_gone_are_told_alike(tmp_path: Path) -> None:
    """So that they fold into one line, which names the folder once."""
    root = str(tmp_path / "gone")
    told = [read(PhotoRef(root, name, ())) for name in ("a.jpg", "more/b.jpg")]
    (detail,) = {one.detail for one in told if isinstance(one, Rejection)}
    assert detail.count(root) == 1
    assert "was the folder moved or renamed?" in detail


def graph(store: Store, rows: int) -> int:
    """Tell how many bytes the pipeline over so many rows has, as runners get it."""
    groups = -(-rows // asked.GROUP)
    todo = Asked("run", rows, rows // 50, groups, rows)
    bench = Bench(store, Versions.present(Models()), Models())
    pipeline = beam.Pipeline(runner="FnApiRunner")
    parts = runs.parts_of(todo.rows)
    write(city(pipeline, todo, bench), bench, todo.run, parts)
    return pipeline.to_runner_api().ByteSize()


def test_the_graph_does_not_grow_with_the_collection(store: Store) -> None:
    small, large = graph(store, 100), graph(store, ROWS)
    assert large < MOST_BYTES
    assert graph(store, 10 * ROWS) < 1.2 * large
    assert large < 1.2 * small
