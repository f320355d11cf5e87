"""Painted boards under neutral file names, from the photograph to the built city."""

from functools import partial
from pathlib import Path

import apache_beam as beam
import cv2
import numpy as np
import pyarrow.parquet as pq
import pytest

from nostalgin_core.scenes.props import board_picture
from pipelines import build
from pipelines.build.bench import Bench
from pipelines.build.boards import Wire, gathered, wire
from pipelines.build.report import Lost
from pipelines.index import Ask
from pipelines.index.index import index
from pipelines.models import Models
from pipelines.store import Store
from pipelines.store.versions import Versions
from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, tree

LIST = """block,lot,street,address,width_m
995,1,Elm Street,1,10
995,2,Elm Street,3,8
996,1,Oak Street,2,7
996,7,Oak Street,4,7
"""
TEXTS = ("995 - 1 M", "995 - 2 M", "996 - 1 M", "")  # the last has no board
WIDE_PX = 210


def photograph(seed: int, text: str, *, turned: bool = False) -> bytes:
    """Paint two fronts and a car, and a number board before them."""
    picture = cv2.imdecode(np.frombuffer(painted.photo(seed), np.uint8), 0)
    if text:
        tone, alpha = board_picture(text, 0.0)
        size = (WIDE_PX, round(WIDE_PX * tone.shape[0] / tone.shape[1]))
        tone, alpha = (
            cv2.resize(o, size, interpolation=cv2.INTER_AREA) for o in (tone, alpha)
        )
        if turned:
            tone, alpha = tone[::-1, ::-1], alpha[::-1, ::-1]
        alpha = alpha / alpha.max()
        y, x = 470, 210
        part = picture[y : y + size[1], x : x + size[0]]
        part[:] = np.rint(part * (1 - alpha) + tone * alpha).astype(np.uint8)
    return cv2.imencode(".png", picture)[1].tobytes()


def city_of(folder: Path, beam: tuple[str, ...] = ()) -> Path:
    """Index painted photographs by their boards."""
    photos, city = folder / "photos", folder / "city"
    photos.mkdir(parents=True)
    for seed, text in enumerate(TEXTS):
        (photos / f"photo_{seed:03}.png").write_bytes(photograph(seed, text))
    (photos / "photo_008.png").write_bytes(photograph(8, "995 - 1 M", turned=True))
    (photos / "photo_009.png").write_bytes(b"no picture")
    (folder / "list.csv").write_text(LIST)
    models = {
        "segment": painted.segment_network(),
        "inpaint": painted.inpaint_network(),
    }
    painted.write_models(folder / "models", **models)
    options = build.options(str(city), models=str(folder / "models"), beam=beam)
    ask = Ask(partial(build.boards, options))
    index(photos, folder / "list.csv", str(city), ask=ask)
    return city


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A city that was indexed by boards, in this process."""
    return city_of(tmp_path_factory.mktemp("boards"))


def test_painted_boards_place_their_photographs_and_no_other(city: Path) -> None:
    table = pq.read_table(city / "readings.parquet").to_pylist()
    put = {
        r["photo"]: (r["verdict"], r["joined_block"], r["joined_lot"]) for r in table
    }
    for name, key in (
        ("photo_000.png", ("995", "1")),
        ("photo_001.png", ("995", "2")),
        ("photo_002.png", ("996", "1")),
    ):
        assert put[name] == ("board", *key)
    for name in ("photo_003.png", "photo_008.png", "photo_009.png"):
        assert put[name][0] in ("silent", "unsure")
        assert put[name][1:] == ("", "")
    assert all(row["remedy"] for row in table if row["verdict"] != "board")


def test_what_index_segmented_build_does_not_segment_again(city: Path) -> None:
    before = {p: p.stat().st_mtime_ns for p in artifacts(city, "segment")}
    assert before
    built(city)
    after = {p: p.stat().st_mtime_ns for p in artifacts(city, "segment")}
    assert after == before


@pytest.mark.timeout(900)  # two cities are indexed, the second by processes
def test_two_processes_hear_the_same(city: Path, tmp_path: Path) -> None:
    other = city_of(tmp_path / "again", ("--direct_num_workers=2",))
    told = ("artifacts/placard/", "artifacts/segment/", "readings")
    one, two = (
        {name: sha for name, sha in tree(each).items() if name.startswith(told)}
        for each in (city, other)
    )
    assert one == two
    assert len(one) > len(TEXTS)


def test_a_second_index_looks_at_nothing_again(city: Path) -> None:
    before = {p: p.stat().st_mtime_ns for p in artifacts(city, "placard")}
    folder = city.parent
    options = build.options(str(city), models=str(folder / "models"))
    ask = Ask(partial(build.boards, options))
    index(folder / "photos", folder / "list.csv", str(city), ask=ask, force=True)
    assert {p: p.stat().st_mtime_ns for p in artifacts(city, "placard")} == before


def test_the_graph_names_no_photograph_and_what_is_heard_has_parts(
    tmp_path: Path,
) -> None:
    bench = Bench(Store(str(tmp_path)), Versions.present(Models()), Models())

    def wired(count: int) -> tuple[bytes, Wire]:
        made = wire(bench, "/photos", [f"photo_{n:07}.png" for n in range(count)])
        pipeline = beam.Pipeline(runner="FnApiRunner")
        made(pipeline)
        return pipeline.to_runner_api().SerializeToString(), made

    (small, few), (large, many) = wired(100), wired(60_000)
    assert len(large) < 1.2 * len(small)
    assert b"photo_0" not in large
    assert (few.parts, many.parts) == (1, 4)
    assert sum(last - first for first, last in many.pieces) == 15
    named = [ref.name for piece in many.pieces for ref in many._refs(piece)]
    assert (len(named), named == sorted(set(named))) == (60_000, True)
    parts = {many._part({"name": name}) for name in named[:100]}
    assert parts == set(range(4))


def test_of_a_photograph_that_is_told_nothing_the_run_is_lost(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    with pytest.raises(Lost, match=r"lost 1 photos' boards, x\.png first"):
        gathered(store, 2, {"x.png"})
