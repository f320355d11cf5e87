"""Known watermarks lie beside the profiles, and a profile says which is meant."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from nostalgin_core.rectify import Watermark
from pipelines.build import mark_of
from pipelines.index import Nothing, index, watermarks
from pipelines.index.index import Question
from pipelines.index.profiles import USUAL, profile
from pipelines.models import Models
from pipelines.site import credited
from pipelines.store import Store
from pipelines.store.versions import CODE, Versions


def own(tmp_path: Path, text: str) -> str:
    file = tmp_path / "own.toml"
    file.write_text(text)
    return str(file)


def test_the_usual_archive_s_watermark_is_known_and_says_its_words() -> None:
    mark = watermarks.watermark(profile(USUAL).watermark)
    assert mark is not None
    assert mark.words == "NYC.gov/records"
    assert 0.15 < mark.covers.max() < 0.35
    assert np.isfinite(mark.adds).all()


def test_every_known_watermark_reads_back_as_it_was_written() -> None:
    for name in watermarks.known():
        data = watermarks.content(name)
        assert watermarks.written(watermarks.read(data)) == data


def test_a_profile_that_names_none_keeps_the_watermark(tmp_path: Path) -> None:
    assert profile("plain").watermark == ""
    assert profile(own(tmp_path, "[board]\npresent = true\n")).watermark == ""
    assert watermarks.watermark("") is None
    assert watermarks.sha256(b"") == ""


def test_a_watermark_that_nobody_knows_is_told_with_those_that_are(
    tmp_path: Path,
) -> None:
    with pytest.raises(Nothing, match=r"watermark\.known: .*nyc-records"):
        profile(own(tmp_path, '[watermark]\nknown = "../nyc-records"\n'))


def test_a_profile_names_a_watermark_that_an_archive_learnt_itself(
    tmp_path: Path,
) -> None:
    learnt = replace(known(), words="A.org", from_top=0.0, wide_px=800)
    (tmp_path / "a.npz").write_bytes(watermarks.written(learnt))
    own_profile = profile(own(tmp_path, '[watermark]\nfile = "a.npz"\n'))
    again = watermarks.loaded(own_profile.mark)
    assert again is not None
    assert (again.words, again.from_top, again.wide_px) == ("A.org", 0.0, 800)
    assert np.array_equal(again.covers, learnt.covers)


@pytest.mark.parametrize(
    "text",
    ['file = "no.npz"', 'file = "bad.npz"', 'file = "a.npz"\nknown = "nyc-records"'],
)
def test_a_watermark_file_of_no_sense_is_told(tmp_path: Path, text: str) -> None:
    (tmp_path / "bad.npz").write_bytes(b"PK no archive")
    (tmp_path / "a.npz").write_bytes(watermarks.written(known()))
    with pytest.raises(Nothing, match=r"watermark\.file"):
        profile(own(tmp_path, f"[watermark]\n{text}\n"))


def test_a_watermark_file_that_unpacks_to_far_more_is_refused() -> None:
    out = io.BytesIO()
    np.savez_compressed(out, covers=np.zeros(9_000_000))
    with pytest.raises(ValueError, match="no watermark"):
        watermarks.own(out.getvalue())


def test_a_city_keeps_the_watermark_that_its_profile_names(tmp_path: Path) -> None:
    data = watermarks.written(replace(known(), words="A.org"))
    (tmp_path / "a.npz").write_bytes(data)
    named = own(tmp_path, '[watermark]\nfile = "a.npz"\n')
    photos = tmp_path / "photos"
    photos.mkdir()
    (photos / "993_8a.jpg").write_bytes(b"\xff\xd8\xff")
    city = str(tmp_path / "city")
    index(photos, None, city, Question(archive=profile(named)))
    assert mark_of(Store(city)) == data


def known() -> Watermark:
    mark = watermarks.watermark("nyc-records")
    assert mark is not None
    return mark


def test_only_straightening_depends_on_what_is_taken_out() -> None:
    bare, clear = (Versions.present(Models(), mark=mark) for mark in ("", "a" * 64))
    differing = {one for one in CODE if getattr(bare, one) != getattr(clear, one)}
    assert differing == {"rectify"}


@pytest.mark.parametrize(
    ("credit", "watermark", "told"),
    [
        ("", "", ""),
        ("An archive", "", "An archive"),
        ("", "A.org", "A.org"),
        ("An archive", "A.org", "An archive; A.org"),
        ("An archive, a.org", "A.org", "An archive, a.org"),
    ],
)
def test_a_credit_says_what_the_watermark_said(
    credit: str, watermark: str, told: str
) -> None:
    assert credited(credit, watermark) == told
