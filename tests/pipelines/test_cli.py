import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from pipelines.cli import app
from pipelines.index import manifest
from pipelines.store import Store
from tests.data import ROOT
from tests.pipelines import painted
from tests.pipelines.hostile import hostile


def nostalgin(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.mark.parametrize("command", ["demo", "index", "build", "view", "explain"])
def test_help_has_examples(command: str) -> None:
    result = nostalgin(command, "--help")
    assert result.exit_code == 0
    assert "Examples" in result.output
    assert f"nostalgin {command}" in result.output


def test_wrong_usage_ends_with_2() -> None:
    assert nostalgin("explain").exit_code == 2
    assert nostalgin("build", "city", "--shard", "9/3").exit_code == 2
    assert nostalgin("build", "city", "--max-rejected", "2").exit_code == 2
    assert nostalgin("build", "city", "another-city").exit_code == 2
    assert nostalgin("demo", "--shard", "1/2").exit_code == 2
    assert nostalgin("no-such-command").exit_code == 2


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["index", "nowhere", "-o", "city"], "nowhere is no folder"),
        (["build", "nowhere"], "nostalgin index"),
        (["view", "nowhere"], "nostalgin build"),
        (["view", "x" * 300], "name a city folder"),
        (["explain", "nowhere.jpg", "-o", "out"], "nowhere.jpg"),
    ],
)
def test_what_is_missing_is_named_with_the_remedy(
    words: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = nostalgin(*words)
    assert result.exit_code == 1
    assert message in result.output
    assert "Traceback" not in result.output


def test_a_second_build_in_a_fresh_process_makes_nothing(tmp_path: Path) -> None:
    city = painted.write_city(tmp_path)
    models = ["--models", str(tmp_path / "models")]
    kept = []
    for seed in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-m", "pipelines.cli", "build", str(city), *models],
            cwd=ROOT,
            env=os.environ | {"PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        files = sorted((city / "artifacts").rglob("*.parquet"))
        kept.append([(file, file.stat().st_mtime_ns) for file in files])
    assert kept[0]
    assert kept[1] == kept[0]


def test_an_index_in_which_most_photos_find_no_place_ends_with_3(
    tmp_path: Path,
) -> None:
    photos, listed = tmp_path / "photos", tmp_path / "list.csv"
    photos.mkdir()
    for name in ("5_1.png", "7_1.png"):
        (photos / name).write_bytes(painted.photo())
    listed.write_text(painted.CATALOGUE)
    words = ("index", photos, "--catalogue", listed, "-o", tmp_path / "city")
    assert nostalgin(*words).exit_code == 0
    (photos / "7_2.png").write_bytes(painted.photo())
    result = nostalgin(*words)
    assert result.exit_code == 3
    assert "2 of 3 photos found no place" in result.output


def test_a_build_without_one_photograph_ends_with_3(tmp_path: Path) -> None:
    city = painted.write_city(tmp_path)
    rows = manifest.read(Store(str(city))).rows
    bare = [
        manifest.row_of("", row.front, root="", credit="") for row in rows if row.front
    ]
    manifest.write(Store(str(city)), bare)
    models = ("--models", tmp_path / "models")
    result = nostalgin("build", city, *models)
    assert result.exit_code == 3, result.output


def test_an_unreadable_photo_ends_with_1_and_without_a_traceback(
    tmp_path: Path,
) -> None:
    photo = tmp_path / "words.jpg"
    photo.write_text("no photograph")
    made = {"segment": painted.segment_network(), "inpaint": painted.inpaint_network()}
    models = painted.write_models(tmp_path / "models", **made)
    result = nostalgin(
        "explain", photo, "-o", tmp_path / "out", "--models", models, "--no-placard"
    )
    assert result.exit_code == 1
    assert "words.jpg" in result.output
    assert "Traceback" not in result.output


def test_a_folder_that_can_not_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "5_1.jpg").write_bytes(b"x")
    result = nostalgin("index", tmp_path / "photos", "-o", tmp_path / "file" / "city")
    assert result.exit_code == 1
    assert "file/city" in result.output
    assert "Traceback" not in result.output


def test_a_name_that_a_terminal_would_obey_is_spelt_out(tmp_path: Path) -> None:
    (tmp_path / "list.csv").write_text("photo,block,lot\n5_1.jpg,5,1\n")
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / "\x1b[2J\n.jpg").write_bytes(b"x")
    words = ["--catalogue", tmp_path / "list.csv", "-o", tmp_path / "city"]
    result = nostalgin("index", tmp_path / "photos", *words)
    assert result.exit_code == 3  # the one photo is on no list
    assert "\x1b[2J" not in result.output
    assert "rejected \\x1b[2J\\n.jpg" in result.output


@pytest.mark.parametrize("command", ["index", "build"])
def test_an_address_that_no_file_system_answers_to_is_named(
    command: str, tmp_path: Path
) -> None:
    (tmp_path / "5_1.jpg").write_bytes(b"x")
    words = {"index": [tmp_path, "-o", "foo://city"], "build": ["foo://city"]}
    result = nostalgin(command, *words[command])
    assert result.exit_code == 1
    assert "foo://city" in result.output
    assert "Traceback" not in result.output


@pytest.mark.parametrize(
    ("row", "words"),
    [("", "it has no rows"), ("a.jpg,9-1-0,9,1,wide\n", "row 2: nonsense cell")],
)
def test_a_manifest_that_names_nothing_to_build_says_why(
    row: str, words: str, tmp_path: Path
) -> None:
    text = "photo,front_id,block,lot,width_m\n" + row
    (tmp_path / "manifest.csv").write_text(text)
    result = nostalgin("build", tmp_path)
    assert result.exit_code == 1
    assert "names no front to build" in result.output
    assert words in result.output
    assert not (tmp_path / "CURRENT").exists()


def test_a_run_that_can_not_be_written_is_told_before_the_work(tmp_path: Path) -> None:
    city = painted.write_city(tmp_path)
    (city / "runs").write_text("in the way")
    result = nostalgin("build", city, "--models", tmp_path / "models")
    assert result.exit_code == 1
    assert str(city) in result.output.replace("\n", "")
    assert "Traceback" not in result.output
    assert not (city / "artifacts").exists()


def test_a_build_of_which_no_block_comes_points_at_no_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def crash(*_: object) -> None:
        raise ArithmeticError("no block can be made")

    monkeypatch.setattr("pipelines.build.blocks.glb", crash)
    city = painted.write_city(tmp_path)
    for name in ("5_1.png", "5_2.jpg", "5_2a.png", "6_1.png"):
        (tmp_path / "photos" / name).write_bytes(b"")
    words = ["build", city, "--models", tmp_path / "models", "--max-rejected", "1"]
    here = ["--stage-seconds", "0"]  # or else the stage is not the one that was spoiled
    assert nostalgin(*words, *here).exit_code == 3
    assert not (city / "CURRENT").exists()


def test_a_demo_that_can_not_be_written_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    result = nostalgin("demo", "-o", tmp_path / "file" / "city", "--no-browser")
    assert result.exit_code == 1
    assert "file/city" in result.output
    assert "Traceback" not in result.output


@pytest.mark.parametrize("port", ["-1", "65536", "http"])
def test_a_port_that_is_none_is_wrong_usage(port: str, tmp_path: Path) -> None:
    assert nostalgin("view", tmp_path, "--port", port).exit_code == 2


@pytest.mark.parametrize(
    "lock", ["", "{", "[]", '{"segment.onnx": 1}', "{}", "[" * 100_000]
)
def test_a_lock_that_makes_no_sense_is_named(tmp_path: Path, lock: str) -> None:
    photo = tmp_path / "photo.png"
    photo.write_bytes(painted.photo())
    (tmp_path / "models.lock").write_text(lock)
    result = nostalgin("explain", photo, "-o", tmp_path / "out", "--models", tmp_path)
    assert result.exit_code == 1
    assert "models.lock" in result.output
    assert "Traceback" not in result.output


def test_a_folder_of_models_without_a_lock_is_refused(tmp_path: Path) -> None:
    photo = tmp_path / "photo.png"
    photo.write_bytes(painted.photo())
    result = nostalgin("explain", photo, "-o", tmp_path / "out", "--models", tmp_path)
    assert result.exit_code == 1
    assert "models.lock" in result.output


def test_a_build_tells_machines_and_rejections_set_the_exit_code(
    tmp_path: Path,
) -> None:
    city = painted.write_city(tmp_path)
    for name in ("5_1.png", "5_2.jpg", "5_2a.png"):
        (tmp_path / "photos" / name).write_bytes(b"")
    models = tmp_path / "models"
    words = ["build", city, "--models", models, "--json"]
    result = nostalgin(*words)
    assert result.exit_code == 3, result.output
    events = [
        json.loads(line) for line in result.output.splitlines() if line[:1] == "{"
    ]
    assert events[0]["event"] == "start"
    assert events[-1]["event"] == "done"
    assert events[-1]["rejected_photos"] == 3
    rejected = {event["key"] for event in events if event["event"] == "rejected"}
    assert rejected == {"5_1.png", "5_2.jpg", "5_2a.png"}
    assert nostalgin(*words, "--max-rejected", "0.8").exit_code == 0
    shutil.rmtree(city / "site")


def test_a_build_counts_photographs_that_have_no_place(tmp_path: Path) -> None:
    """Of four photographs two have no front, and one has a row that makes no sense."""
    city = painted.write_city(tmp_path)
    store = Store(str(city))
    rows = [manifest.typed(row) for row in manifest.read(store).rows]
    bare = dict.fromkeys(manifest.FRONT.names)
    for row in rows:
        row.update(bare if row["photo"] in ("5_2.jpg", "5_2a.png") else {})
    manifest.write(store, rows)
    text = (city / manifest.CSV).read_text()
    spoiled = re.sub(r"(?m)^(.*6_1\.png.*),(True|False),", r"\1,maybe,", text)
    assert spoiled != text
    (city / manifest.CSV).write_text(spoiled)
    words = ["build", city, "--models", tmp_path / "models", "--max-rejected", "0.8"]
    result = nostalgin(*words)
    assert result.exit_code == 0, result.output
    assert "4 photos, 3 of them gave nothing" in result.output
    assert nostalgin(*words, "--max-rejected", "0.7").exit_code == 3
    assert "25% of them shown" in nostalgin("status", city).output


def test_help_answers_without_loading_beam() -> None:
    report = "import sys, pipelines.cli; print('apache_beam' in sys.modules)"
    told = subprocess.check_output([sys.executable, "-c", report], text=True)
    assert told.strip() == "False"


@pytest.mark.parametrize("kind", ["pipe", "device", "holes"])
def test_a_photo_that_has_no_end_is_named_and_spoils_no_other(
    tmp_path: Path, kind: str
) -> None:
    city = painted.write_city(tmp_path)
    photo = hostile(tmp_path / "photos" / "5_1.png", kind)
    models = ("--models", tmp_path / "models")
    result = nostalgin("build", city, *models)
    assert result.exit_code == 0, result.output
    assert "rejected 5_1.png: photo: unreadable file" in result.output
    assert "2 blocks" in result.output
    result = nostalgin("explain", photo, "-o", tmp_path / "out", *models)
    assert result.exit_code == 1
    assert "5_1.png: " in result.output


def test_a_scheme_is_reached_only_if_it_is_allowed(tmp_path: Path) -> None:
    text = "root,photo,front_id,block,lot\ngs://nowhere,a.jpg,9-1-0,9,1\n"
    (tmp_path / "manifest.csv").write_text(text)
    result = nostalgin("build", tmp_path)
    assert result.exit_code == 1
    assert "manifest.csv row 2: scheme not allowed" in result.output
    assert "--allow-scheme gs" in result.output
    assert nostalgin("build", tmp_path, "--allow-scheme", "gs://x/").exit_code == 2


@pytest.mark.parametrize("data", [b"", b"\x08\x07" * 500, painted.inpaint_network()])
def test_a_network_that_does_not_run_is_told_before_the_work(
    tmp_path: Path, data: bytes
) -> None:
    city = painted.write_city(tmp_path)
    made = {"segment": data, "inpaint": painted.inpaint_network()}
    models = ("--models", painted.write_models(tmp_path / "relocked", **made))
    result = nostalgin("build", city, *models)
    assert result.exit_code == 1
    assert "segment.onnx does not run" in result.output
    assert not (city / "artifacts").exists()
    photo = tmp_path / "photos" / "5_1.png"
    told = nostalgin("explain", photo, "-o", tmp_path / "out", *models, "--no-placard")
    assert told.exit_code == 1
    assert "segment.onnx does not run" in told.output


def test_a_credit_that_is_no_text_is_told(tmp_path: Path) -> None:
    (tmp_path / "5_1.jpg").write_bytes(b"x")
    words = ("-o", tmp_path / "city", "--credit", "\udcff")
    result = nostalgin("index", tmp_path, *words)
    assert result.exit_code == 1
    assert "is not UTF-8" in result.output


COMMAND = (sys.executable, "-m", "pipelines.cli")


def ended(*words: str, tail: str) -> tuple[int, str]:
    """Run a command in a shell; give its exit code and standard error."""
    line = f"{shlex.join([*COMMAND, *words])} {tail}; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(
        ["bash", "-c", line], cwd=ROOT, capture_output=True, text=True, check=False
    )
    return done.returncode, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("how", "tail", "told"),
    [
        (("--json",), "| head -c0", "standard output: "),
        (("--json",), ">/dev/full", "standard output: No space left on device"),
        (("--json",), ">&-", ""),
        ((), "2>&1 | head -c0", ""),
        ((), "2>/dev/full", ""),
        ((), "2>&-", ""),
    ],
)
def test_an_index_that_nobody_hears_is_made_all_the_same(
    tmp_path: Path, how: tuple[str, ...], tail: str, told: str
) -> None:
    photos = tmp_path / "photos"
    photos.mkdir()
    (photos / "5_1.jpg").write_bytes(b"x")
    city = tmp_path / "city"
    words = ("index", str(photos), "-o", str(city), *how)
    code, said = ended(*words, tail=tail)
    assert code == 0, said
    assert told in said
    assert "Traceback" not in said
    assert (city / "manifest.parquet").exists()


def test_files_may_be_smaller_than_what_is_written(tmp_path: Path) -> None:
    photos = tmp_path / "photos"
    photos.mkdir()
    for lot in range(1, 400):
        (photos / f"5_{lot}.jpg").write_bytes(b"x")
    line = shlex.join([*COMMAND, "index", str(photos), "-o", str(tmp_path / "city")])
    done = subprocess.run(
        ["bash", "-c", f"ulimit -f 4; {line}"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "allow larger files (ulimit -f)" in done.stderr
    assert "Traceback" not in done.stderr
