"""What lies in a bucket, whichever server keeps it."""

import hashlib
import http
import http.client
from pathlib import Path

import pyarrow.fs as pafs

BUCKET = "archive"


def objects(bucket: str, folder: str) -> dict[str, bytes]:
    """Read all objects below a folder of a bucket."""
    system, root = pafs.FileSystem.from_uri(f"{bucket}/{folder}")
    at = pafs.FileSelector(root, recursive=True, allow_not_found=True)
    found = [one.path for one in system.get_file_info(at) if one.is_file]
    start = len(f"{root}/")
    return {path[start:]: system.open_input_file(path).read() for path in found}


def tree(bucket: str, folder: str) -> dict[str, str]:
    """Hash all objects below a folder, but for those that tell the time."""
    return {
        name: hashlib.sha256(data).hexdigest()
        for name, data in objects(bucket, folder).items()
        if not name.endswith(("run.json", ".prom"))
    }


def put(bucket: str, path: Path, name: str) -> None:
    """Copy a file into a bucket."""
    system, target = pafs.FileSystem.from_uri(f"{bucket}/{name}")
    with system.open_output_stream(target) as stream:
        stream.write(path.read_bytes())


def posted(port: int, path: str, body: str = "") -> None:
    """Post to a server on this machine.

    Raises:
        OSError: if nobody answers, or not well.
    """
    server = http.client.HTTPConnection("127.0.0.1", port)
    server.request("POST", path, body, {"Content-Type": "application/json"})
    status = server.getresponse().status
    server.close()
    if status != http.HTTPStatus.OK:
        raise OSError(f"{path}: {status}")
