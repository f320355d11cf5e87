import pytest

from pipelines.build.options import options
from pipelines.index.roots import rooted, screened
from pipelines.index.row import Row
from pipelines.store import Store, secretive

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
