import pytest

from nostalgin_core.records import Elevation, Facade, Occluder, Rejection, Seen
from pipelines.store import tables


@pytest.mark.parametrize("kept", [(Elevation, Seen, Rejection), (Facade, Occluder)])
def test_records_that_share_a_table_agree_on_their_columns(
    kept: tuple[type, ...],
) -> None:
    columns: dict[str, object] = {}
    for record in kept:
        for column in tables.schema(record):
            assert columns.setdefault(column.name, column.type) == column.type
