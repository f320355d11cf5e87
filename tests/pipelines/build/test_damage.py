"""What was damaged is made again; what is worse takes nothing's place."""

import hashlib
import json
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.pipelines import painted
from tests.pipelines.cities import artifacts, built, copied, tree

HERE = ("--stage_seconds=0",)  # no process of its own: it is faster
STAGES = (
    *("segment", "matte", "rectify", "compare"),
    *("borrow", "inpaint", "block", "thumbnail"),
)


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A painted city that was built once."""
    city = painted.write_city(tmp_path_factory.mktemp("painted"))
    built(city, HERE)
    return city


def twin(city: Path, folder: Path) -> Path:
    """Copy a city with all that it has."""
    other = copied(city, folder)
    shutil.copytree(city, other, dirs_exist_ok=True)
    return other


def spoil(path: Path) -> None:
    """Zero 64 bytes in the middle of a file's data."""
    data = path.read_bytes()
    at = len(data) // 3
    path.write_bytes(data[:at] + bytes(64) + data[at + 64 :])


@pytest.mark.parametrize("stage", [*STAGES, ""])
def test_damage_heals(city: Path, tmp_path: Path, stage: str) -> None:
    other = twin(city, tmp_path)
    made = artifacts(other, stage)
    assert made
    for path in made:
        spoil(path)
    shutil.rmtree(other / "site")
    report = built(other, HERE)
    assert tree(other / "site") == tree(city / "site")
    assert not list(report.rejections)
    # Of the others all is there that was made of them.
    read = ("compare", "block", "thumbnail", "")
    assert (report.healed > 0) is (stage in read)


def test_what_is_made_from_damage_is_made_from_what_was_healed(
    city: Path, tmp_path: Path
) -> None:
    other = twin(city, tmp_path)
    for path in artifacts(other, ""):
        if path.parts[-4] in ("segment", "rectify", "inpaint"):
            spoil(path)
        else:
            path.unlink()
    assert built(other, HERE).healed
    for folder in ("site", "runs"):  # what no wall wears was not looked at
        assert tree(other / folder) == tree(city / folder)


def test_a_city_that_shows_less_takes_no_better_one_s_place(
    tmp_path: Path,
) -> None:
    other = painted.write_city(tmp_path)
    assert not built(other, HERE).held
    site, current = tree(other / "site"), (other / "CURRENT").read_text()
    for path in (other.parent / "photos").iterdir():
        path.write_bytes(b"")
    for _ in range(2):  # the second finds the first one's tables, and is not misled
        report = built(other, HERE)
        assert (report.held, report.rejected_photos) == (True, 4)
        assert tree(other / "site") == site
        assert (other / "CURRENT").read_text() == current
    assert not built(other, (*HERE, "--publish_anyway")).held
    assert tree(other / "site") != site


def contents(tile: dict[str, Any]) -> Iterator[str]:
    """Name what a tile and those below it show."""
    if "content" in tile:
        yield tile["content"]["uri"]
    for child in tile.get("children", ()):
        yield from contents(child)


def test_a_reader_meets_one_city_or_the_other_while_they_change(
    city: Path, tmp_path: Path
) -> None:
    other = twin(city, tmp_path)
    listed = other / "manifest.csv"
    stop, torn, read = threading.Event(), [], []

    def reader() -> None:
        while not stop.is_set():
            record = json.loads((other / "site/site.json").read_text())
            tiles = json.loads((other / "site" / record["tileset"]).read_text())
            named = set(contents(tiles["root"]))
            told = [block["uri"] for block in record["blocks"]]
            named |= {block["record"] for block in record["blocks"]}
            there = all((other / "site" / uri).is_file() for uri in named)
            fine = sorted(uri for uri in named if uri.startswith("blocks/"))
            torn.extend([] if fine == sorted(told) and there else [told])
            read.append(told)

    thread = threading.Thread(target=reader)
    thread.start()
    for before, after in (("Elm", "Ash"), ("Ash", "Fir")):
        listed.write_text(listed.read_text().replace(before, after))
        built(other, HERE)
    stop.set()
    thread.join()
    assert torn == []
    assert len({tuple(told) for told in read}) == 3


BROKEN = """
import os, sys
from pathlib import Path
from typing import Any
from nostalgin_core import matte
from pipelines import cli

sound, key, calls = matte.matte, sys.argv.pop(), Path(sys.argv.pop())

def broken(picture, found):
    if picture.key == key:
        calls.open("a").write("x")
        os.abort()
    return sound(picture, found)

matte.matte = broken
cli.main()
"""


def test_a_photo_that_kills_its_stage_is_put_aside_and_stops_no_other(
    city: Path, tmp_path: Path
) -> None:
    other, calls = copied(city, tmp_path), tmp_path / "calls"
    photo = (city.parent / "photos/5_1.png").read_bytes()
    key = hashlib.sha256(photo).hexdigest()[:16]
    words = ["build", str(other), "--models", str(tmp_path / "models")]
    for _ in range(2):  # the second run knows it, and doesn't try again
        command = [sys.executable, "-c", BROKEN, *words, str(calls), key]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        assert "5_1.png: matte: put aside: its process died 2 times" in done.stderr
        assert "1 of them gave nothing" in done.stderr
        assert calls.read_text() == "xx"
