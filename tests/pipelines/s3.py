"""A real S3 server on this machine, and city folders in it."""

import logging
from collections.abc import Iterator

import boto3
import pytest
from moto.server import ThreadedMotoServer
from werkzeug.serving import WSGIRequestHandler

from pipelines.store.disk import reached
from tests.pipelines.buckets import BUCKET, posted

SECRET = "a-secret-that-nobody-should-read"  # noqa: S105


@pytest.fixture
def bucket(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """Start a server with one empty bucket, and give its URI."""
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    posted(port, "/moto-api/reset")  # it keeps what an earlier one was given
    told = {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ACCESS_KEY_ID": "somebody",
        "AWS_SECRET_ACCESS_KEY": SECRET,
        "AWS_REGION": "us-east-1",
        "AWS_DEFAULT_REGION": "us-east-1",
        "AWS_EC2_METADATA_DISABLED": "true",
    }
    for name, value in told.items():
        monkeypatch.setenv(name, value)
    boto3.client("s3").create_bucket(Bucket=BUCKET)
    reached.cache_clear()  # of another server
    yield f"s3://{BUCKET}"
    reached.cache_clear()
    server.stop()


def requests(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """List the methods of all requests from now on, as they come."""
    heard: list[str] = []

    def log(self: WSGIRequestHandler, *_: object) -> None:
        heard.append(self.command)

    monkeypatch.setattr(WSGIRequestHandler, "log_request", log)
    return heard
