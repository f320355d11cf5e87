"""What `index` warned of comes back as it was told."""

from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from nostalgin_core.catalogue import Doubt
from nostalgin_core.records import Rejection
from pipelines.index import warned
from pipelines.store import Store

DOUBTS = (
    Doubt("a list is empty"),
    Doubt(
        "block 5, lot 3 (13 Elm): row 4: it is odd",
        *("5", "3", (4,), "13 Elm", ("7 Elm", "13 Oak")),
    ),
    Doubt("row 9 names a.jpg", "5", "1", (9,), photo="a.jpg", named=("5", "2")),
)
REJECTED = Rejection("row 2", "catalogue", "no block", "write one")


def test_what_was_warned_of_is_read_as_it_was_told(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    warned.write(store, [REJECTED], DOUBTS)
    found = warned.read(store)
    assert found.doubts == DOUBTS
    told = {"key": "row 2", "reason": "no block", "detail": "write one"}
    assert found.rejections == (told,)


def test_a_table_of_an_earlier_release_has_words_alone(tmp_path: Path) -> None:
    rows = [{"key": "", "reason": "", "detail": "block 5, lot 3: it is odd"}]
    pq.write_table(pa.Table.from_pylist(rows), tmp_path / warned.TABLE)
    found = warned.read(Store(str(tmp_path)))
    assert found.doubts == (Doubt("block 5, lot 3: it is odd"),)
