from dataclasses import replace

import pytest

from nostalgin_core.records import Front
from pipelines.index.manifest import Manifest
from pipelines.index.roots import located
from pipelines.index.row import Row

FRONT = Front("1-1-0", "1", "1", 0, 0, 0, "Elm Street", "1", 8.0, None, False)  # noqa: FBT003


def manifest(*roots: str) -> Manifest:
    rows = [Row(n, root, "a.jpg", FRONT, "", {}) for n, root in enumerate(roots, 2)]
    return Manifest(tuple(rows), (), (), "")


@pytest.mark.parametrize("root", ["gs://b/p", "GS://b/p", " gs://b", "http://h", "://"])
def test_a_scheme_that_nobody_allowed_costs_its_row_alone(root: str) -> None:
    found = located(manifest("/photos", root), "city", ("s3",))
    assert [row.root for row in found.rows] == ["/photos"]
    (one,) = found.rejections
    assert (one.key, one.reason) == ("manifest.csv row 3", "scheme not allowed")
    assert "--allow-scheme" in one.detail


@pytest.mark.parametrize(
    ("root", "city", "schemes"),
    [
        ("/photos", "city", ()),
        ("photos", "s3://bucket/city", ()),
        ("s3://bucket/photos", "s3://bucket/city", ()),
        ("file:///photos", "city", ()),
        ("gs://bucket/photos", "city", ("gs",)),
        ("GS://bucket/photos", "city", ("s3", "gs")),
    ],
)
def test_paths_the_city_s_own_scheme_and_what_is_allowed_are_built(
    root: str, city: str, schemes: tuple[str, ...]
) -> None:
    found = located(manifest(root), city, schemes)
    assert (len(found.rows), found.rejections) == (1, ())


def test_what_was_rejected_before_stays_so() -> None:
    before = located(manifest("gs://b", "/p"), "city", ())
    assert located(before, "city", ("gs",)).rejections == before.rejections
    assert replace(before, rejections=()) != before
