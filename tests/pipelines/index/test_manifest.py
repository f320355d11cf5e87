import io
import json
import re
import weakref
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from nostalgin_core.catalogue.entry import inside
from nostalgin_core.records import Front
from pipelines.index import cells, comma, manifest
from pipelines.index.manifest import Unusable
from pipelines.index.source import KEPT
from pipelines.store.store import Store
from tests.data import ROOT

FRONT = Front("993-1-0", "993", "1", 0, 0, 0, "7 Avenue", "561-565", 18.06, 18.3, False)  # noqa: FBT003
CORNER = Front("993-1-1", "993", "1", 0, 1, 1, "West 40 Street", "", 7.62, None, True)  # noqa: FBT003


def rows() -> list[dict]:
    return [
        manifest.row_of("a.jpg", FRONT, root="/photos", credit="An archive"),
        manifest.row_of("a.jpg", CORNER, root="/photos", credit="An archive"),
        manifest.row_of("", CORNER, root="/photos", credit=""),
        manifest.row_of("stray.jpg", None, root="/photos", credit=""),
    ]


@pytest.fixture
def store(tmp_path: Path) -> Store:
    store = Store(str(tmp_path))
    manifest.write(store, rows())
    return store


def edit(store: Store, change: tuple[str, str]) -> None:
    path = Path(store.root) / manifest.CSV
    text = path.read_text()
    assert change[0] in text
    path.write_text(text.replace(*change))


def test_what_was_written_is_read_back(store: Store) -> None:
    found = manifest.read(store)
    assert [(row.photo, row.front) for row in found.rows] == [
        ("a.jpg", FRONT),
        ("", CORNER),
        ("a.jpg", CORNER),
        ("stray.jpg", None),
    ]
    assert (found.rejections, found.warnings) == ((), ())


@pytest.mark.parametrize("lost", [manifest.CSV, manifest.PARQUET])
def test_either_form_says_the_same(store: Store, lost: str) -> None:
    both = manifest.read(store)
    (Path(store.root) / lost).unlink()
    assert manifest.read(store).rows == both.rows


@pytest.mark.parametrize("data", ["", "\n", "\ufeff\n"])
def test_an_empty_manifest_is_called_empty(store: Store, data: str) -> None:
    (Path(store.root) / manifest.CSV).write_text(data)
    with pytest.raises(
        manifest.Unusable, match=r"is empty: delete it, or run .*--force"
    ):
        manifest.read(store)


def test_a_mended_csv_wins(store: Store) -> None:
    edit(store, ("561-565", "561"))
    assert manifest.read(store).rows[0].front.address == "561"  # type: ignore[union-attr]


def test_the_title_is_kept_also_when_the_csv_is_mended(store: Store) -> None:
    manifest.write(store, rows(), title="Midtown, 1940")
    assert manifest.read(store).title == "Midtown, 1940"
    edit(store, ("561-565", "561"))
    found = manifest.read(store)
    assert (found.mended, found.title) == (True, "Midtown, 1940")


def test_a_manifest_without_a_title_has_none(store: Store) -> None:
    assert manifest.read(store).title == ""


def test_a_mended_csv_is_written_anew_and_says_the_same(store: Store) -> None:
    edit(store, ("561-565", "561"))
    mended = manifest.read(store)
    manifest.rewrite(store, mended)
    again = manifest.read(store)
    assert mended.mended
    assert not again.mended
    fronts = [(row.photo, row.front, row.credit) for row in mended.rows]
    assert [(row.photo, row.front, row.credit) for row in again.rows] == fronts


def test_a_mended_csv_is_left_alone_while_a_row_of_it_is_rejected(store: Store) -> None:
    edit(store, ("18.06", "wide"))
    before = (Path(store.root) / manifest.CSV).read_bytes()
    manifest.rewrite(store, manifest.read(store))
    assert (Path(store.root) / manifest.CSV).read_bytes() == before
    assert manifest.read(store).rejections


def test_an_untouched_csv_is_not_read(store: Store) -> None:
    before = manifest.read(store)
    path = Path(store.root) / manifest.CSV
    path.write_bytes(path.read_bytes())
    assert manifest.read(store).sha256 == before.sha256


def test_unknown_columns_are_kept_with_a_warning(store: Store) -> None:
    manifest.write(store, [row | {"remark": "torn"} for row in rows()])
    found = manifest.read(store)
    assert len(found.warnings) == 1
    assert "remark" in found.warnings[0]
    assert {row.cells["remark"] for row in found.rows} == {"torn"}


def test_columns_of_a_list_need_no_warning_even_when_mended(store: Store) -> None:
    manifest.write(store, [row | {"remark": "torn"} for row in rows()], kept=["remark"])
    assert manifest.read(store).warnings == ()
    path = Path(store.root) / manifest.CSV
    path.write_text(path.read_text().replace("torn", "whole"))
    mended = manifest.rewrite(store, manifest.read(store))
    assert mended.warnings == ()
    assert {row.cells["remark"] for row in mended.rows} == {"whole"}


@pytest.mark.parametrize(
    "path",
    ["../a.jpg", "b/../../a.jpg", "/etc/a.jpg", "a\0.jpg"],
)
def test_a_path_that_leads_outside_is_inside_nothing(path: str) -> None:
    assert not inside(path)


@pytest.mark.parametrize("path", ["c:a.jpg", "C:\\a.jpg", "..\\a.jpg", "\\a.jpg"])
def test_drives_and_backslashes_lead_outside_on_windows_alone(path: str) -> None:
    assert inside(path)
    assert not inside(path, windows=True)


@pytest.mark.parametrize("path", ["a.jpg", "b/a.jpg", "b/..a.jpg", "a..b.jpg", ""])
def test_a_path_below_is_inside(path: str) -> None:
    assert inside(path)


@pytest.mark.parametrize(
    ("change", "reason", "words"),
    [
        (("a.jpg,An archive,993-1-0", "../a.jpg,,993-1-0"), "path outside", "../a.jpg"),
        (("18.06", "wide"), "nonsense cell", "width_m is 'wide'"),
        (("18.06", "-3"), "nonsense cell", "width_m is '-3'"),
        (("18.06", "nan"), "nonsense cell", "width_m is 'nan'"),
        (("18.06", "0"), "nonsense cell", "width_m is '0'"),
        (("18.06", "1e300"), "nonsense cell", "not 1 to 400 metres"),
        (("18.3", "1e-9"), "nonsense cell", "not 1 to 400 metres"),
        (("18.06", "9" * 5000), "nonsense cell", "999...', not"),
        (("993,1,0,0,0", "993,1,1e30,0,0"), "nonsense cell", "ring is '1e30'"),
        (("993,1,0,0,0", "993,1,0,1000000,0"), "nonsense cell", "up to 99"),
        (("993,1,0,0,0", "993,1,0,0,0.5"), "nonsense cell", "rank is '0.5'"),
        (("False", "perhaps"), "nonsense cell", "perhaps"),
        (("993-1-0,993", "993-1-0,"), "nonsense cell", "block is empty"),
        (("561-565", "561,565"), "", ""),
        (("561-565", "5" * 10_000_000), "cell too long", "10,000,000 letters"),
    ],
)
def test_a_bad_row_is_named_and_spoils_no_other(
    store: Store, change: tuple[str, str], reason: str, words: str
) -> None:
    edit(store, change)
    found = manifest.read(store)
    (bad,) = found.rejections
    assert bad.key == "manifest.csv row 2"
    assert reason in bad.reason
    assert words in bad.detail
    assert len(found.rows) == 3


def test_an_empty_line_is_counted_and_else_ignored(store: Store) -> None:
    edit(store, ("\n/photos,stray.jpg", "\n\n,,,\n/photos,../stray.jpg"))
    found = manifest.read(store)
    assert len(found.rows) == 3
    assert [one.key for one in found.rejections] == ["manifest.csv row 7"]


def test_a_row_that_tells_a_front_otherwise_than_another_is_named(store: Store) -> None:
    edit(store, ("/photos,a.jpg,An archive,993-1-1", "/photos,a.jpg,Other,993-1-1"))
    assert manifest.read(store).warnings == ()
    edit(store, ("a.jpg,Other,993-1-1,993,1,0,1,1", "a.jpg,Other,993-1-1,993,1,0,1,7"))
    (warning,) = manifest.read(store).warnings
    assert warning.startswith("manifest.csv row 4: rank of front 993-1-1")
    assert "row 3, which counts" in warning


def test_a_row_of_nothing_is_refused(store: Store) -> None:
    edit(store, ("stray.jpg", ""))
    assert [one.reason for one in manifest.read(store).rejections] == ["empty row"]


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xff\xfe\x00nonsense",
        b"a,b\n1,2\n",
        b"photo;lot\n",
        b"photo\n\0\n",
        b'photo,"\n',
    ],
)
def test_nonsense_is_refused_by_name(store: Store, data: bytes) -> None:
    (Path(store.root) / manifest.CSV).write_bytes(data)
    with pytest.raises(Unusable, match=r"manifest\.csv"):
        manifest.read(store)


def test_a_broken_parquet_file_is_refused_by_name(store: Store) -> None:
    (Path(store.root) / manifest.PARQUET).write_bytes(b"PAR1nonsense")
    with pytest.raises(Unusable, match=r"manifest\.parquet"):
        manifest.read(store)


def test_parquet_whose_words_are_no_text_is_refused_by_name(store: Store) -> None:
    path = Path(store.root) / manifest.PARQUET
    table = pq.read_table(path)
    odd = pa.array([b"\xff.jpg"] * table.num_rows, pa.binary())
    words = pa.Array.from_buffers(pa.string(), len(odd), odd.buffers())
    pq.write_table(table.set_column(1, "photo", words), path)
    with pytest.raises(Unusable, match=r"manifest\.parquet is no Parquet file"):
        manifest.read(store)


def test_parquet_that_claims_more_rows_than_a_city_has_is_refused(store: Store) -> None:
    path = Path(store.root) / manifest.PARQUET
    rows = pa.table({"photo": pa.nulls(comma.MOST_ROWS + 1, pa.string())})
    pq.write_table(rows, path)
    assert path.stat().st_size < 1_000_000
    with pytest.raises(Unusable, match="more than 5,000,000 rows"):
        manifest.read(store)


def test_a_word_that_is_repeated_without_end_is_refused(store: Store) -> None:
    path = Path(store.root) / manifest.PARQUET
    numbers, words = pa.array([0] * 20_000, pa.int32()), pa.array(["x" * 100_000])
    photos = pa.DictionaryArray.from_arrays(numbers, words)  # 2 GB, if written out
    pq.write_table(pa.table(dict.fromkeys(manifest.REQUIRED, photos)), path)
    (Path(store.root) / manifest.CSV).unlink()  # or else that is read
    assert path.stat().st_size < 1_000_000
    with pytest.raises(Unusable, match="Larger than the 250,000,000 bytes"):
        manifest.read(store)


def test_no_manifest_is_refused_with_the_remedy(tmp_path: Path) -> None:
    with pytest.raises(Unusable, match="nostalgin index"):
        manifest.read(Store(str(tmp_path)))


def test_a_width_left_empty_is_assumed(store: Store) -> None:
    edit(store, ("18.06", ""))
    front = manifest.read(store).rows[0].front
    assert front is not None
    assert front.width_assumed
    assert front.width_m == cells.ASSUMED_WIDTH_M


def test_a_block_s_name_may_have_any_number_of_digits() -> None:
    huge = "9" * 5000
    assert sorted([huge, "10"], key=manifest.natural) == ["10", huge]


def test_blocks_stand_in_the_order_of_their_numbers() -> None:
    assert sorted(["10", "9", "b", None], key=manifest.natural) == [
        "9",
        "10",
        None,
        "b",
    ]


class Counted(dict[str, Any]):
    """A row of which it can be told whether it is still held."""

    __hash__ = object.__hash__


def test_rows_that_are_made_one_at_a_time_are_not_held() -> None:
    alive: weakref.WeakSet[Counted] = weakref.WeakSet()
    most = 0

    def made() -> Iterator[Counted]:
        nonlocal most
        for number in reversed(range(4 * manifest.GROUP)):
            row = Counted(rows()[0] | {"photo": f"{number}.jpg", "rank": number})
            alive.add(row)
            most = max(most, len(alive))
            yield row

    _, parquet = manifest.encoded(made())
    ranks = pq.read_table(io.BytesIO(parquet), columns=["rank"])["rank"].to_pylist()
    assert ranks == list(range(4 * manifest.GROUP))
    assert most <= 2 * manifest.GROUP  # the last group, and the one that is made


def test_columns_of_some_rows_are_columns_of_all() -> None:
    some = [rows()[0] | {"z": "1"}, rows()[1] | {"a": "2"}, rows()[2]]
    text, parquet = manifest.encoded(iter(some), kept=None)
    table = pq.read_table(io.BytesIO(parquet))
    assert table.column_names == [*manifest.SCHEMA.names, "a", "z"]
    assert sorted(map(str, table["z"].to_pylist())) == ["1", "None", "None"]
    assert text.decode().splitlines()[0].endswith(",a,z")
    marks = pq.read_schema(io.BytesIO(parquet)).metadata
    assert json.loads(marks[KEPT]) == ["a", "z"]


def test_every_column_is_documented() -> None:
    page = (ROOT / "docs" / "manifest.md").read_text()
    documented = set(re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE))
    assert documented == {*manifest.SCHEMA.names, *manifest.TOLD}
