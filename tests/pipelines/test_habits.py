"""Habits of the command line: version, quiet, completion, alike things at once."""

import io
import json
from collections.abc import Iterator
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import typer
from rich.console import Console
from typer.testing import CliRunner, Result

from nostalgin_core.catalogue import Doubt
from nostalgin_core.measure.overlays import Learnt
from nostalgin_core.records import Box, Photo
from nostalgin_core.rectify import Watermark
from pipelines.cli import app
from pipelines.console import Voice, indexed
from pipelines.index.index import Indexed, index
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
    assert "1 width assumed" in nostalgin(*words, "-o", tmp_path / "city").output


def commands(group: Any, *path: str) -> Iterator[tuple[str, Any]]:
    """Walk through all commands that the program has, evaluate's tables too."""
    for name, one in group.commands.items():
        if hasattr(one, "commands"):
            yield from commands(one, *path, name)
        else:
            yield " ".join((*path, name)), one


EVERY = dict(commands(typer.main.get_command(app)))
PHOTO, MODELS = "{city}/../photos/5_1.png", "--models {city}/../models"
MEASURED = {  # which module's report, and which one's words
    "segmentation": ("segmentation", "segmentation_table"),
    "rectification": ("rectification", "rectification_table"),
    **{one: (one, one) for one in ("inpainting", "slips", "heights", "views")},
    **{one: (one, one) for one in ("fronts", "borrowed", "placards", "watermark")},
    "city": ("layout", "layout"),
}
TWO = ("heights", "city", "fronts", "placards")  # of which two folders are asked
WORDS = {
    "explain": f"explain {PHOTO} -o {{city}}/out --no-placard {MODELS}",
    "explain-front": "explain-front {city} 5-1-0 -o {city}/out",
    "index": "index {city}/../photos -o {city}/new",
    "build": f"build {{city}} {MODELS}",
    "publish": "publish {city} {city}/public",
    "demo": "demo -o {city}/demo",
    "reprocess": f"reprocess {{city}} {MODELS}",
    "schedule": f"schedule {{city}} --once --cron * {MODELS}",
    "status": "status {city}",
    "watermark": "watermark {city}/../photos -o {city}/out.npz --words A.org",
    "workers": "workers",
    **{
        one: f"{one} {{city}}"
        for one in ("check", "corrections", "review", "view", "export", "report", "gc")
    },
    **{
        f"evaluate {one}": f"evaluate {one} {{city}}" + " {city}/out" * (one in TWO)
        for one in MEASURED
    },
}


@pytest.fixture
def stubbed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Take away what takes long, and what goes on until it is interrupted."""
    for report, words in MEASURED.values():
        measured = import_module(f"pipelines.evaluate.{report}")
        monkeypatch.setattr(measured, "evaluate", lambda *_, **__: {})
        table = import_module(f"pipelines.evaluate.{words}")
        monkeypatch.setattr(table, "text", lambda _: "a table\nof two lines")
    monkeypatch.setattr("pipelines.evaluate.labels.pairs", lambda *_, **__: [])
    monkeypatch.setattr("pipelines.build.serve", lambda *_: None)
    monkeypatch.setattr("pipelines.view.Server.serve_forever", lambda _: None)
    tile = np.zeros((8, 8), np.float32)
    mark = Watermark("A.org", tile, tile, (0.3, 0.2))
    looked = [Photo("k", np.zeros((9, 9), np.uint8), Box(0, 0, 9, 9))]
    learnt = Learnt(20, 30.0, 0.9, 20, mark), looked
    monkeypatch.setattr("pipelines.index.learning.learnt", lambda *_: learnt)
    front = {"unseen": 0.1, "left": 0.0, "photo": "5_1.png", "views": ()}
    monkeypatch.setattr("pipelines.explain.explain_front", lambda *_: front)
    none = Indexed(0, 0, 0, (), 0, (), (Doubt("a warning"),))
    monkeypatch.setattr("pipelines.demo.painted", lambda *_, **__: ("", ""))
    monkeypatch.setattr("pipelines.index.index", lambda *_, **__: none)
    monkeypatch.setattr("pipelines.cli.demo.built", lambda *_, **__: None)


@pytest.mark.usefixtures("stubbed")
@pytest.mark.parametrize("name", EVERY)
def test_every_command_is_quiet_if_it_is_told_to(name: str, other: Path) -> None:
    assert name in WORDS, f"say by which words {name} is to be tried"
    words = [word.format(city=other) for word in WORDS[name].split()]
    (other.parent / "photos").mkdir()
    (other.parent / "photos" / "5_1.png").write_bytes(painted.photo())
    if name == "schedule":
        words[words.index("*")] = "* * * * *"
    loud = nostalgin(*words)
    assert bool(loud.output) is (name != "workers"), loud.output
    quiet = nostalgin(*words, "--quiet")
    assert (loud.exit_code, quiet.exit_code, quiet.output) == (0, 0, "")
    assert nostalgin(*words, "-q").output == ""


def test_a_plan_is_told_to_those_who_are_not_quiet_alone(other: Path) -> None:
    words = ("reprocess", other, "--dry-run", "--models", other.parent / "models")
    assert "nothing is stale" in nostalgin(*words).output
    assert nostalgin(*words, "--quiet").output == ""
