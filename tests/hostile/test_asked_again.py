"""What a city folder says it was indexed with leads nowhere off this machine."""

import json
import socket
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

import pytest
from typer.testing import CliRunner

from pipelines.cli.program import app
from pipelines.index.again import RECORD, Kept, Wish
from tests.pipelines import painted


@pytest.fixture
def heard() -> Iterator[socket.socket]:
    """Listen, so that whoever fetches is heard."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(0.2)
        yield server


@pytest.mark.parametrize("scheme", ["https", "http", "HTTPS", "s3"])
@pytest.mark.parametrize("name", ["catalogue", "photos", "profile", "places"])
def test_a_foreign_record_has_nothing_fetched(
    tmp_path: Path, heard: socket.socket, scheme: str, name: str
) -> None:
    city = painted.write_city(tmp_path)
    where = f"{scheme}://127.0.0.1:{heard.getsockname()[1]}/list.csv"
    wish = asdict(Wish(str(tmp_path / "photos"))) | {name: where}
    record = asdict(Kept(Wish(""), "0", looked=False, astray=False)) | {"wish": wish}
    (city / RECORD).write_text(json.dumps(record))
    words = ["reprocess", str(city), "--dry-run", "--models", str(tmp_path / "models")]
    done = CliRunner().invoke(app, words)
    with pytest.raises(TimeoutError):
        heard.accept()
    assert done.exit_code == 0, done.output
    assert "4 new" in done.output
