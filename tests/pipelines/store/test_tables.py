import dataclasses

import numpy as np
import pyarrow as pa
import pytest

from nostalgin_core import quantise
from nostalgin_core.records import (
    Assignment,
    Box,
    Elevation,
    Facade,
    Front,
    Instance,
    Occluder,
    Photo,
    Placard,
    Rejection,
    Seen,
)
from pipelines.store import tables

RNG = np.random.default_rng(7)
GRAY = RNG.integers(0, 256, (9, 7), dtype=np.uint8)
MASK = RNG.random((9, 7)) < 0.5
SOFT = quantise.soft(RNG.random((9, 7)))
CORNERS = RNG.normal(size=(4, 2))
BOARD = ((0.0, 1.0), (2.0, 1.0), (2.0, 3.0), (0.0, 3.0))

ELEVATION = Elevation(
    facade=1,
    image=GRAY,
    alpha=SOFT,
    evidence=GRAY % 8,
    quad=CORNERS,
    photo_from_elevation=RNG.normal(size=(3, 3)),
    vanishing_points=RNG.normal(size=(2, 3)),
    focal_px=None,
    aspect=0.77,
    vanishing_sd_deg=(0.5, 0.7),
    focal_sd_px=12.5,
    aspect_sd=0.01,
    method="two vanishing points",
)
RECORDS = [
    Rejection("k", "matte", "no facade", "look", 2),
    Rejection("k", "matte", "no facade"),
    Photo("0123456789abcdef", GRAY, Box(1, 2, 6, 8)),
    Instance("person", 0.75, Box(0, 0, 7, 9), SOFT),
    Occluder("vehicle", 0.5, MASK),
    Facade(0, 0.9, True, 0.8, MASK, ~MASK, SOFT),  # noqa: FBT003
    ELEVATION,
    Placard("993-11", "993", None, "M", 0.9, BOARD),
    Front("993-11-2", "993", "11", 0, 2, 1, "Broadway", "", 18.3, None, True),  # noqa: FBT003
    Seen("k", 0, True, 0.9, 0.8, 0.7, 0.01, 250.5, 1e5, 0.95),  # noqa: FBT003
    Assignment("993-11-2", "k", 0, 0.93),
]


def same(a: object, b: object) -> bool:
    """Tell whether two records agree in every field, arrays included."""
    pairs = [
        (getattr(a, field.name), getattr(b, field.name))
        for field in dataclasses.fields(a)  # type: ignore[arg-type]
    ]
    return type(a) is type(b) and all(
        np.array_equal(x, y) and x.dtype == y.dtype
        if isinstance(x, np.ndarray)
        else x == y
        for x, y in pairs
    )


@pytest.mark.parametrize("record", RECORDS, ids=lambda one: type(one).__name__)
def test_a_record_comes_back_from_its_table_as_it_was(record: object) -> None:
    table = tables.table(type(record), [record])
    (back,) = tables.records(type(record), table)
    assert same(back, record)


def test_the_comparison_can_fail() -> None:
    other = dataclasses.replace(ELEVATION, image=GRAY.copy() ^ 1)
    assert not same(ELEVATION, other)


def test_columns_that_are_no_fields_are_ignored() -> None:
    row = tables.to_row(RECORDS[-1]) | {"remark": "mended by hand"}
    assert tables.from_row(Assignment, row) == RECORDS[-1]


def test_a_table_of_no_records_has_all_columns() -> None:
    assert tables.table(Seen, []).schema == tables.schema(Seen)


def test_what_no_column_can_hold_is_refused() -> None:
    with pytest.raises(ValueError, match="complex"):
        tables.column(complex)


def test_an_optional_number_is_still_a_number() -> None:
    assert tables.schema(Elevation).field("focal_px").type == pa.float64()


def test_an_empty_image_has_no_bytes() -> None:
    assert tables.to_png(np.zeros((0, 5), np.uint8)) == b""
    assert tables.from_png(b"").size == 0
