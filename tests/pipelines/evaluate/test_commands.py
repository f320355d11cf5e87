from pathlib import Path

import pytest
from typer.testing import CliRunner

from pipelines.cli import app


def told(*words: object) -> str:
    """Run a measurement that can't be made, and give what it says."""
    result = CliRunner().invoke(app, ["evaluate", *map(str, words)])
    assert result.exit_code == 1
    assert result.exception is None or isinstance(result.exception, SystemExit)
    return result.output.replace("\n", " ")


@pytest.mark.parametrize("table", ["segmentation", "rectification", "inpainting"])
def test_a_folder_that_is_not_there_is_named(table: str, tmp_path: Path) -> None:
    assert "nowhere" in told(table, tmp_path / "nowhere")


@pytest.mark.parametrize("table", ["segmentation", "inpainting"])
def test_networks_that_are_not_there_are_named(table: str, tmp_path: Path) -> None:
    (tmp_path / "labels").mkdir()
    (tmp_path / "photos").mkdir()
    (tmp_path / "labels" / "1.json").write_text('{"objects": []}')
    (tmp_path / "photos" / "1.jpg").write_bytes(b"x")
    assert "models.lock" in told(table, tmp_path, "--models", tmp_path / "nowhere")


@pytest.mark.parametrize(
    "label",
    [
        b"",
        b"\xff\xfe",
        b"[]",
        b"{}",
        b'{"objects": [7]}',
        b'{"objects": [{"category": "facade"}]}',
        b'{"objects": [{"category": "facade", "polygon": [[0, 0], [1]]}]}',
        b'{"objects": [{"category": null, "polygon": [[0, 0], [1, 1], [0, 1]]}]}',
    ],
)
def test_a_label_that_is_none_is_named(label: bytes, tmp_path: Path) -> None:
    (tmp_path / "labels").mkdir()
    (tmp_path / "photos").mkdir()
    (tmp_path / "labels" / "1.json").write_bytes(label)
    (tmp_path / "photos" / "1.jpg").write_bytes(b"x")
    assert "1.json is no label" in told("segmentation", tmp_path)
