"""Known watermarks lie beside the profiles, and a profile says which is meant."""

from pathlib import Path

import numpy as np
import pytest

from pipelines.index import Nothing, watermarks
from pipelines.index.profiles import USUAL, profile
from pipelines.models import Models
from pipelines.site import credited
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
    assert watermarks.sha256("") == ""


def test_a_watermark_that_nobody_knows_is_told_with_those_that_are(
    tmp_path: Path,
) -> None:
    with pytest.raises(Nothing, match=r"watermark\.known: .*nyc-records"):
        profile(own(tmp_path, '[watermark]\nknown = "../nyc-records"\n'))


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
