"""Hostile photographs, names and rows are told one by one, and spoil no others."""

import csv
import os
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from nostalgin_core import photo
from nostalgin_core.records import Photo, Rejection
from pipelines.build.stages import read
from pipelines.index import manifest
from pipelines.index.plan import PhotoRef
from pipelines.store import Store
from tests.hostile import catalogues, folders, images, manifests, names
from tests.hostile.case import BUILD_S, bounded, parameters
from tests.hostile.conftest import BUILT, GOOD, TAKEN, Listed, Told
from tests.hostile.images import HostileImage
from tests.hostile.names import HostileName

built = partial(parameters, within_s=BUILD_S)


@pytest.mark.parametrize("case", parameters("image", images.cases()))
def test_an_image_is_decoded_or_refused_with_the_reason(case: HostileImage) -> None:
    data = case.make()
    with bounded():
        result = photo.decode(data, name=case.name)
    if case.reason:
        assert isinstance(result, Rejection)
        assert result.reason == case.reason
        assert result.detail.startswith(f"{case.name}: ")
        assert "; " in result.detail  # and the remedy
    else:
        assert isinstance(result, Photo), result
        assert result.image.dtype == np.uint8
        assert min(result.image.shape) >= 64


SENT = [one for one in images.cases() if one.reason or one.name in TAKEN]


@pytest.mark.parametrize("case", built("built image", SENT))
def test_a_city_tells_why_an_image_shows_nothing(
    case: HostileImage, told: Told
) -> None:
    (why, *more) = told.rejected[f"images/{case.name}"]
    if case.reason:
        assert why["reason"] == case.reason
        assert case.name in why["detail"]
        assert not more
    assert not any(one["reason"] == "crashed" for one in (why, *more))


@pytest.mark.parametrize("case", built("name", names.cases()))
def test_a_name_that_a_disk_takes_is_shown_or_told(
    case: HostileName, told: Told
) -> None:
    name = os.fsdecode(case.file)
    if not case.reason:
        assert name in told.shown
        return
    spelt = case.file.decode(errors="backslashreplace")
    every = [(key, one) for key, its in told.rejected.items() for one in its]
    own = [
        one
        for key, one in every
        if spelt == key or repr(spelt) in one["detail"].partition(";")[0]
    ]
    assert case.reason in {one["reason"] for one in own}
    assert name not in told.shown


def test_the_good_ones_are_built(told: Told) -> None:
    assert told.codes == (0, 0)
    assert set(GOOD) <= told.shown
    assert "5" in told.blocks


def test_nothing_is_written_but_the_city(told: Told) -> None:
    there = {path.name for path in told.folder.iterdir()}
    assert there == {"photos", "models", "city"}
    assert {path.name for path in (told.folder / "city").iterdir()} - {".lock"} == BUILT


@pytest.mark.parametrize("case", built("manifest row", manifests.rows()))
def test_a_row_of_a_manifest_is_built_or_told(
    case: manifests.HostileRow, told: Told
) -> None:
    number = told.numbers[case.called]
    photograph = case.cells.get("photo", "")
    own = [
        one
        for key, its in told.rejected.items()
        for one in its
        if key == f"manifest.csv row {number}"
        or one["detail"].startswith(f"manifest.csv row {number}:")
        or (case.reason == manifests.UNREADABLE and case.told_by(key, one["detail"]))
    ]
    if case.reason:
        assert case.reason in {one["reason"] for one in own}, photograph
    else:
        assert not own
        assert case.cells["block"] in told.blocks


@pytest.mark.parametrize("case", parameters("catalogue row", catalogues.rows()))
def test_a_row_of_a_catalogue_is_a_front_or_told(
    case: catalogues.HostileRow, listed: Listed
) -> None:
    number = listed.numbers[case.called]
    own = listed.rejected.get(f"list.csv row {number}", [])
    if case.reason:
        assert [one["reason"] for one in own] == [case.reason]
        assert own[0]["detail"]
    else:
        assert not own
        assert case.called in listed.blocks


def test_a_good_row_is_kept_beside_hostile_ones(listed: Listed) -> None:
    assert listed.code == 0
    found = manifest.read(Store(str(listed.city)))
    assert {row.photo for row in found.rows if row.photo} == {catalogues.GOOD}
    assert not found.rejections


FORMULAS = [one for one in catalogues.captions() if one.called.startswith("formula")]


@pytest.mark.parametrize("case", parameters("formula", FORMULAS))
def test_a_formula_is_none_in_the_manifest(
    case: catalogues.HostileRow, listed: Listed
) -> None:
    """A spreadsheet takes for one what starts with =, +, - or @."""
    text = (listed.city / manifest.CSV).read_text(encoding="utf-8")
    (own,) = [
        row for row in csv.DictReader(text.splitlines()) if row["block"] == case.called
    ]
    for cell in own.values():
        assert not cell.startswith(("=", "+", "-", "@"))


@pytest.mark.parametrize("case", parameters("photo", folders.unreadable()))
def test_a_photo_that_is_no_file_of_bytes_is_refused(
    case: folders.Unreadable, tmp_path: Path
) -> None:
    case.put(tmp_path / "x.jpg")
    with bounded():
        result = read(PhotoRef(str(tmp_path), "x.jpg", ("5",)))
    assert not (tmp_path / folders.WAITED).exists()
    assert isinstance(result, Rejection)
    assert result.key == "x.jpg"
    assert str(tmp_path) in result.detail
