import errno
from pathlib import Path

import pytest

from pipelines.build.options import options
from pipelines.index.roots import rooted, screened
from pipelines.index.row import Row
from pipelines.store import Store, secretive
from pipelines.store.disk import GOOGLE, worded

SECRET = "s3://someone:hush@bucket/city"  # noqa: S105


@pytest.mark.parametrize("plain", ["/a@b/c", "s3://bucket/a@b", "gs://bucket", "a:b@c"])
def test_an_at_sign_in_a_path_is_no_secret(plain: str) -> None:
    assert not secretive(plain)


def test_credentials_in_a_uri_are_refused_and_not_repeated() -> None:
    with pytest.raises(OSError, match="Credentials in the URI") as told:
        Store(SECRET).exists("a")
    with pytest.raises(ValueError, match="Credentials in the URI") as refused:
        options(SECRET)
    row = screened(Row(2, SECRET, "a.jpg", None, "", {}), "/city", ("s3",))
    for said in (str(told.value), str(refused.value), repr(row)):
        assert "hush" not in said
    assert not row


def test_a_relative_root_keeps_what_a_bucket_is_asked_with() -> None:
    city = "s3://bucket/city?region=us-east-1"
    assert rooted("../photos", city) == "s3://bucket/photos?region=us-east-1"


def test_who_has_no_credentials_for_google_is_told_how_to_give_them(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("GOOGLE_APPLICATION_CREDENTIALS", str(tmp_path / "none"))
    with pytest.raises(OSError, match="give credentials by GOOGLE_") as told:
        Store("gs://bucket/city").exists("a")
    assert told.value.errno == errno.EIO
    assert "cloud::Status" not in str(told.value)


def test_words_that_are_not_googles_are_left_alone() -> None:
    for problem in (OSError("of another"), FileNotFoundError(errno.ENOENT, GOOGLE)):
        with pytest.raises(OSError) as told, worded():  # noqa: PT011
            raise problem
        assert told.value is problem
