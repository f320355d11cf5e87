"""A real Google Cloud Storage server on this machine, and city folders in it.

It is fake-gcs-server, which `make gcs` builds from Go's module proxy.
"""

import json
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import pytest
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import rsa

from pipelines.store.disk import reached
from tests.pipelines.buckets import BUCKET, posted

PRIVATE: Final = "PRIVATE KEY"  # what a log must never hold
NAME: Final = "fake-gcs-server"
BESIDE: Final = Path(sys.executable).with_name(NAME)
SERVER: Final = shutil.which(NAME) or (str(BESIDE) if BESIDE.exists() else "")
START_S: Final = 20.0

needs_server = pytest.mark.skipif(not SERVER, reason=f"no {NAME}: run `make gcs`")


def credentials(path: Path) -> Path:
    """Write a service account's file, with a key of its own."""
    key = rsa.generate_private_key(public_exponent=65537, key_size=2048)
    pem = key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    ).decode()
    told = {"type": "service_account", "project_id": BUCKET, "private_key": pem}
    told |= {"private_key_id": "1", "client_id": "1", "client_email": "a@b.example"}
    told |= {"token_uri": "http://127.0.0.1:9/token"}  # asked of nobody
    path.write_text(json.dumps(told))
    return path


def started(port: int) -> subprocess.Popen[bytes]:
    """Start a server with one empty bucket."""
    words = ["-scheme", "http", "-host", "127.0.0.1", "-port", str(port)]
    words += ["-backend", "memory", "-public-host", f"127.0.0.1:{port}"]
    nowhere = subprocess.DEVNULL
    server = subprocess.Popen([SERVER, *words], stdout=nowhere, stderr=nowhere)
    until = time.monotonic() + START_S
    while True:
        try:
            posted(port, "/storage/v1/b?project=p", json.dumps({"name": BUCKET}))
        except OSError:
            if time.monotonic() > until or server.poll() is not None:
                raise
            time.sleep(0.05)
        else:
            return server


@pytest.fixture
def google(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[str]:
    """Start a server with one empty bucket, and give its URI."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        port = one.getsockname()[1]
    server = started(port)
    own = credentials(tmp_path / "account.json")
    monkeypatch.setenv("CLOUD_STORAGE_EMULATOR_ENDPOINT", f"http://127.0.0.1:{port}")
    monkeypatch.setenv("GOOGLE_APPLICATION_CREDENTIALS", str(own))
    reached.cache_clear()  # of another server
    yield f"gs://{BUCKET}"
    reached.cache_clear()
    server.terminate()
    server.wait()
