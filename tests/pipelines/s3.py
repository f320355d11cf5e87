"""A real S3 server on this machine, and city folders in it."""

import hashlib
import logging
from collections.abc import Iterator
from pathlib import Path

import boto3
import pyarrow.fs as pafs
import pytest
from moto.server import ThreadedMotoServer
from werkzeug.serving import WSGIRequestHandler

from pipelines.store.disk import reached

SECRET = "a-secret-that-nobody-should-read"  # noqa: S105
BUCKET = "archive"


@pytest.fixture
def bucket(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """Start a server with one empty bucket, and give its URI."""
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
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


def objects(folder: str) -> dict[str, bytes]:
    """Read all objects below a folder of the bucket."""
    system, _ = pafs.FileSystem.from_uri(f"s3://{BUCKET}")
    at = pafs.FileSelector(f"{BUCKET}/{folder}", recursive=True)
    found = [one.path for one in system.get_file_info(at) if one.is_file]
    start = len(f"{BUCKET}/{folder}/")
    return {path[start:]: system.open_input_file(path).read() for path in found}


def tree(folder: str) -> dict[str, str]:
    """Hash all objects below a folder, but for those that tell the time."""
    return {
        name: hashlib.sha256(data).hexdigest()
        for name, data in objects(folder).items()
        if not name.endswith(("run.json", ".prom"))
    }


def put(path: Path, name: str) -> None:
    """Copy a file into the bucket."""
    system, _ = pafs.FileSystem.from_uri(f"s3://{BUCKET}")
    with system.open_output_stream(f"{BUCKET}/{name}") as stream:
        stream.write(path.read_bytes())
