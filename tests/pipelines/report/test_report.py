import fcntl
import json
import os
import re
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from pipelines import report
from pipelines.cli import app
from pipelines.report.figures import Times
from pipelines.store import Store, runs

RUN = "0123456789ab"
HOSTILE = "<script>alert(1)</script>\u202e&\x1b[31m.jpg"


def building(
    name: str, *, height_m: float = 12.0, share: float = 0.8
) -> dict[str, Any]:
    return {
        "id": name,
        "lot": name,
        "address": f"{name} Broadway",
        "photos": [{"key": f"key-{name}", "used": True, "caption": HOSTILE}],
        "height_m": height_m,
        "height_low_m": height_m / 2,
        "height_high_m": height_m * 2,
        "height_assumed": False,
        "width_assumed": name.endswith("1"),
        "assumed": False,
        "photographed_share": share,
    }


def block(name: str, buildings: list[dict[str, Any]]) -> dict[str, Any]:
    numbers = {"low_m": [0.0] * 3, "high_m": [1.0] * 3, "closures_m": [0.0]}
    return {
        **numbers,
        "block": name,
        "model": "m",
        "sha256": "s",
        "outlines_m": [[0.0]],
        "buildings": len(buildings),
        "assumed": 0,
        "credit": "",
        "record": json.dumps({"block": name, "buildings": buildings}),
    }


@pytest.fixture
def store(tmp_path: Path) -> Store:
    """A city with one run: four photos, two of them rejected, two blocks."""
    made = Store(str(tmp_path / "city"))
    names = ["a.jpg", "b.jpg", HOSTILE, "d.jpg"]
    photos = [
        {"name": name, "root": "/", "key": f"key-{i}", "sha256": "", "blocks": ["9"]}
        for i, name in enumerate(names)
    ]
    runs.write_table(made, RUN, "photos", photos)
    facades = [
        {"name": name, "elevations": "e"} for name in ("a.jpg", "a.jpg", "b.jpg")
    ]
    runs.write_table(made, RUN, "facades", facades)
    why = {"stage": "segment", "reason": "no facade", "detail": "", "facade": None}
    runs.write_table(made, RUN, "rejections", [why | {"key": n} for n in names[2:]])
    blocks = [
        block("10", [building("10-1", height_m=300, share=0.0), building("10-2")]),
        block("9", [building("9-1", share=1.0)]),
    ]
    runs.write_table(made, RUN, "blocks", blocks)
    spent = {"median_ms": 400, "p90_ms": 800, "longest_ms": 900, "spans": {"500": 3}}
    segment = {"cpu_milliseconds": 1500, "made": 3, "skipped": 1, **spent}
    times = {"segment": segment, "photo": {"made": 4}}
    told = {"run": RUN, "began": "2026-11-22T10:00:00Z", "seconds": 12.0}
    made.write_bytes(
        f"runs/{RUN}/run.json", json.dumps(told | {"stages": times}).encode()
    )
    published = json.dumps({"photos": 4, "shown_share": 0.5}).encode()
    made.write_bytes(f"runs/{RUN}/published.json", published)
    made.write_bytes("CURRENT", f"{RUN}\n".encode())
    return made


def test_every_photo_and_every_building_is_counted_once(store: Store) -> None:
    found = report.figures(store)
    assert (found.photos, found.useless, found.facades) == (4, 2, 3)
    assert sum(bar.value for bar in found.reasons) == 2
    assert sum(bar.value for bar in found.shares) == found.buildings == 3
    assert sum(bar.value for bar in found.heights) == found.buildings
    assert found.heights[-1].value == 1  # the one that is higher than any edge
    assert found.guessed_widths == 2
    assert [one["block"] for one in found.of_blocks] == ["9", "10"]
    assert found.stages[0].name == "segment"
    assert found.stages[0].note == "3 made, 0.50 s each"
    assert found.times == (Times("segment", 3, 1, 0.4, 0.8, 0.9),)


def test_the_worst_come_first(store: Store) -> None:
    found = report.figures(store)
    assert [one.note[:4] for one in found.least_seen[:1]] == ["10-1"]
    assert [one.photo for one in found.rejected] == sorted([HOSTILE, "d.jpg"])


def test_the_page_holds_all_it_shows_and_obeys_no_name(store: Store) -> None:
    store.write_bytes("site/photos/key-9-1.webp", b"RIFF")
    store.write_bytes("site/photos/key-10-1.svg", b"<svg onload='alert(1)'/>")
    text = report.page(report.figures(store), store, title=HOSTILE)
    assert "<script" not in text
    assert "&lt;script&gt;" in text
    sources = re.findall(r'(?:src|href)="([^"]*)"', text)
    assert set(sources) == {"data:image/webp;base64,UklGRg=="}
    assert text == report.page(report.figures(store), store, title=HOSTILE)


@pytest.mark.parametrize("torn", [b"", b"[]", b"{", b'{"seconds": "x", "stages": {}}'])
def test_a_torn_record_of_a_run_is_no_failure(store: Store, torn: bytes) -> None:
    store.write_bytes(f"runs/{RUN}/run.json", torn)
    assert report.figures(store).stages == ()
    (past,) = report.history(store)
    assert (past.seconds, past.current) == (None, True)


def test_the_history_tells_how_runs_ended(store: Store) -> None:
    began = json.dumps({"began": "2026-11-23T10:00:00Z"}).encode()
    store.write_bytes("runs/ffffffffffff/run.json", began)
    states = [(one.run, one.state) for one in report.history(store)]
    assert states == [(RUN, "shown"), ("ffffffffffff", "unfinished")]


def test_the_commands_tell_and_write(store: Store, tmp_path: Path) -> None:
    told = CliRunner().invoke(app, ["status", store.root])
    assert told.exit_code == 0
    assert "4 photos, 50% of them shown" in told.stdout
    out = tmp_path / "page.html"
    assert (
        CliRunner().invoke(app, ["report", store.root, "-o", str(out)]).exit_code == 0
    )
    assert out.read_text().startswith("<!doctype html>")


def test_a_run_at_work_is_told(store: Store) -> None:
    lock = Path(store.root) / ".lock"
    lock.write_text(json.dumps({"process": 7, "host": "here", "began": "now"}))
    held = os.open(lock, os.O_RDWR)
    try:
        assert "at work" not in CliRunner().invoke(app, ["status", store.root]).stdout
        fcntl.flock(held, fcntl.LOCK_EX)
        told = CliRunner().invoke(app, ["status", store.root]).stdout
    finally:
        os.close(held)
    assert "at work there (process 7 on here since now)" in told


@pytest.mark.parametrize("command", ["report", "status"])
def test_a_folder_without_a_city_is_told(tmp_path: Path, command: str) -> None:
    told = CliRunner().invoke(app, [command, str(tmp_path)])
    assert "nostalgin build" in told.output
    assert told.exit_code == (1 if command == "report" else 0)


def test_an_unknown_run_is_told(store: Store) -> None:
    with pytest.raises(report.NoRun, match="run nothing left no tables"):
        report.figures(store, "nothing")
