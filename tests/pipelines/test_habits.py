"""Habits of the command line: version, quiet, completion, alike things at once."""

import io
import json
from importlib.metadata import version
from pathlib import Path

from rich.console import Console
from typer.testing import CliRunner, Result

from pipelines.cli import app
from pipelines.console import Voice, indexed
from pipelines.index.index import index
from tests.pipelines import painted


def nostalgin(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


def photos(folder: Path, *names: str) -> Path:
    folder.mkdir()
    for name in names:
        (folder / name).write_bytes(painted.photo())
    return folder


def test_the_version_is_told() -> None:
    result = nostalgin("--version")
    assert (result.exit_code, result.output.strip()) == (
        0,
        f"nostalgin {version('nostalgin')}",
    )


def test_completion_is_offered() -> None:
    assert "--install-completion" in nostalgin("--help").output


def test_a_quiet_index_tells_nothing_and_writes_the_same(tmp_path: Path) -> None:
    folder = photos(tmp_path / "photos", "5_1.png", "5_2.png")
    loud = nostalgin("index", folder, "-o", tmp_path / "loud")
    quiet = nostalgin("index", folder, "-o", tmp_path / "quiet", "--quiet")
    assert loud.output
    assert (quiet.exit_code, quiet.output) == (0, "")
    written = [(tmp_path / c / "manifest.csv").read_bytes() for c in ("loud", "quiet")]
    assert written[0] == written[1]


def test_a_quiet_index_still_tells_what_went_wrong(tmp_path: Path) -> None:
    result = nostalgin("index", tmp_path, "-o", tmp_path / "city", "-q")
    assert result.exit_code == 1
    assert "holds no image" in result.output


def test_what_was_rejected_alike_is_told_at_once(tmp_path: Path) -> None:
    names = [f"x_{number:05}_0001.png" for number in range(1, 72)]
    folder = photos(tmp_path / "photos", *names)
    (tmp_path / "list.csv").write_text("block,lot\n993,1\n996,1\n997,1\n")
    made = index(folder, tmp_path / "list.csv", str(tmp_path / "city"))
    sink = io.StringIO()
    indexed(made, "city", Voice(Console(file=sink, soft_wrap=True)))
    (line,) = [one for one in sink.getvalue().splitlines() if "rejected" in one]
    assert line.startswith("rejected 71 (x_00001_0001.png, ")
    assert "its block is not on the list: it has 993, 996, 997" in line


def test_a_machine_is_told_of_each(tmp_path: Path) -> None:
    folder = photos(tmp_path / "photos", "x_00001_0001.png", "x_00002_0001.png")
    (tmp_path / "list.csv").write_text("block,lot\n993,1\n")
    words = ("index", folder, "--catalogue", tmp_path / "list.csv")
    result = nostalgin(*words, "-o", tmp_path / "city", "--json")
    assert result.exit_code == 3
    events = [json.loads(line) for line in result.output.splitlines() if line[0] == "{"]
    assert sum(one["event"] == "rejected" for one in events) == 2


def test_a_summary_says_how_many_widths_are_assumed(tmp_path: Path) -> None:
    folder = photos(tmp_path / "photos", "5_1.png", "5_2.png")
    (tmp_path / "list.csv").write_text("block,lot,width_m\n5,1,6\n5,2,\n")
    words = ("index", folder, "--catalogue", tmp_path / "list.csv")
    assert "1 widths assumed" in nostalgin(*words, "-o", tmp_path / "city").output
