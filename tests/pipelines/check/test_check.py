"""A city folder is looked over: what is planted is found, and nothing else."""

import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner, Result

from pipelines.check import check
from pipelines.check.copies import MOST_APART, likenesses, pairs
from pipelines.cli import app
from pipelines.index.index import index
from pipelines.store import Store

HEAD = "photo,block,lot,street,address,width_m,credit\n"
SOUND = [
    f"5_{n}.png,5,{n},Elm Street,{2 * n + 1},{6 + n / 10},An Archive"
    for n in range(1, 8)
]


def city(folder: Path, lines: list[str], pictures: dict[str, bytes]) -> Path:
    (folder / "photos").mkdir()
    for name, data in pictures.items():
        (folder / "photos" / name).write_bytes(data)
    (folder / "list.csv").write_text(HEAD + "\n".join(lines) + "\n")
    index(folder / "photos", folder / "list.csv", str(folder / "city"))
    return folder / "city"


def pictures(count: int = 7) -> dict[str, bytes]:
    """Paint pictures that look like nothing else."""
    rng = np.random.default_rng(5)
    made = {}
    for n in range(1, count + 1):
        coarse = rng.integers(0, 255, (9, 9)).astype(np.uint8)
        image = cv2.resize(coarse, (320, 240), interpolation=cv2.INTER_CUBIC)
        made[f"5_{n}.png"] = cv2.imencode(".png", image)[1].tobytes()
    return made


def kinds(folder: Path, **options: Any) -> list[tuple[str, bool]]:
    return [(one.kind, one.grave) for one in check(Store(str(folder)), **options)]


def nostalgin(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


def test_of_a_sound_city_nothing_is_told(tmp_path: Path) -> None:
    sound = city(tmp_path, SOUND, pictures())
    assert kinds(sound) == []
    assert nostalgin("check", sound, "--strict").exit_code == 0


PLANTED: dict[str, tuple[int, str]] = {
    "width far out": (2, "5_3.png,5,3,Elm Street,7,95,An Archive"),
    "rights missing": (3, "5_4.png,5,4,Elm Street,9,6.4,"),
    "address of two lots": (1, "5_2.png,5,2,Elm Street,3,6.2,An Archive"),
}


@pytest.mark.parametrize("kind", PLANTED)
def test_what_is_planted_in_a_row_is_found(kind: str, tmp_path: Path) -> None:
    place, line = PLANTED[kind]
    lines = [*SOUND[:place], line, *SOUND[place + 1 :]]
    found = check(Store(str(city(tmp_path, lines, pictures()))), pictures=False)
    (one,) = [finding for finding in found if finding.kind == kind]
    assert not one.grave
    assert one.row.startswith("manifest.csv")
    assert one.remedy


def test_a_street_without_numbers_is_told_once(tmp_path: Path) -> None:
    lines = [f"5_{n}.png,5,{n},Elm Street,,7,An Archive" for n in range(1, 8)]
    assert kinds(city(tmp_path, lines, pictures())) == [
        ("street without numbers", False)
    ]


def test_a_file_that_is_gone_is_grave_and_ends_with_3(tmp_path: Path) -> None:
    sound = city(tmp_path, SOUND, pictures())
    (tmp_path / "photos" / "5_6.png").unlink()
    assert kinds(sound) == [("missing file", True)]
    result = nostalgin("check", sound, "--json")
    assert result.exit_code == 3
    events = [json.loads(line) for line in result.output.splitlines()]
    assert events[-1] == {
        "event": "done",
        "grave": 1,
        "doubts": 0,
        "kinds": {"missing file": 1},
    }
    assert "5_6.png" in events[0]["what"]


def test_the_same_file_under_two_lots_is_grave(tmp_path: Path) -> None:
    painted_so = pictures()
    painted_so["5_2.png"] = painted_so["5_1.png"]
    assert kinds(city(tmp_path, SOUND, painted_so)) == [("same file", True)]


def test_a_picture_saved_anew_and_smaller_looks_the_same(tmp_path: Path) -> None:
    painted_so = pictures()
    data = np.frombuffer(painted_so["5_1.png"], np.uint8)
    small = cv2.resize(cv2.imdecode(data, cv2.IMREAD_GRAYSCALE), (200, 150))
    painted_so["5_2.png"] = cv2.imencode(".jpg", small)[1].tobytes()
    sound = city(tmp_path, SOUND, painted_so)
    assert kinds(sound) == [("looks the same", False)]
    assert kinds(sound, pictures=False) == []
    assert nostalgin("check", sound).exit_code == 0
    assert nostalgin("check", sound, "--strict").exit_code == 3


def test_prints_on_light_paper_are_told_once(tmp_path: Path) -> None:
    painted_so = pictures()
    for name in ("5_2.png", "5_4.png"):
        data = np.frombuffer(painted_so[name], np.uint8)
        picture = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE) // 2
        card = np.pad(picture, ((14, 40), (16, 16)), constant_values=230)
        painted_so[name] = cv2.imencode(".png", card)[1].tobytes()
    found = check(Store(str(city(tmp_path, SOUND, painted_so))))
    assert [(one.kind, one.grave) for one in found] == [("light border", False)]
    assert "5_2.png, one of 2" in found[0].what


def test_a_picture_that_is_none_is_told(tmp_path: Path) -> None:
    broken = pictures() | {"5_5.png": b"no picture"}
    assert kinds(city(tmp_path, SOUND, broken)) == [("unreadable picture", True)]


def test_a_bad_correction_is_told(tmp_path: Path) -> None:
    sound = city(tmp_path, SOUND, pictures())
    (sound / "corrections.csv").write_text("photo,what,value\nx.png,key,5-1\n")
    assert kinds(sound) == [("no such photo", True)]


def test_a_city_that_is_none_ends_with_1(tmp_path: Path) -> None:
    result = nostalgin("check", tmp_path / "nowhere")
    assert result.exit_code == 1
    assert "nostalgin index" in result.output


def test_nothing_is_written(tmp_path: Path) -> None:
    sound = city(tmp_path, SOUND, pictures())
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")}
    check(Store(str(sound)))
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*")} == before


@pytest.mark.parametrize("seed", range(5))
def test_pairs_of_hashes_agree_with_all_comparisons(seed: int) -> None:
    rng = np.random.default_rng(seed)
    codes = rng.integers(0, 2**63, 200, dtype=np.uint64)
    for i in range(0, 200, 4):  # some of them near to others, by up to nine bits
        flips = rng.choice(64, int(rng.integers(10)), replace=False)
        mask = sum(1 << int(bit) for bit in flips)
        codes[i + 1] = codes[i] ^ np.uint64(mask)
    apart = np.bitwise_count(codes[:, None] ^ codes[None])
    slow = [
        (i, j)
        for i in range(200)
        for j in range(i + 1, 200)
        if apart[i, j] <= MOST_APART
    ]
    assert pairs(codes) == slow
    assert slow


def test_of_no_hashes_there_are_no_pairs() -> None:
    assert pairs(np.zeros(0, np.uint64)) == []


LOTS = """
[names]
patterns = ['^L(?P<lot>[0-9]+)_B(?P<block>[0-9]+)$']
"""


@pytest.mark.parametrize(
    ("own", "name", "told"),
    [
        (LOTS, "L0002_B00005.png", True),
        (LOTS, "L0001_B00005.png", False),
        (LOTS, "x_00005_0002.png", False),  # as New York names them
        ("", "x_00005_0002.png", False),
        (None, "x_00005_0002.png", True),
    ],
)
def test_names_are_read_as_the_city_was_indexed(
    own: str | None, name: str, *, told: bool, tmp_path: Path
) -> None:
    (tmp_path / "photos").mkdir()
    (tmp_path / "photos" / name).write_bytes(b"x")
    listed = tmp_path / "list.csv"
    listed.write_text(f"{HEAD}{name},5,1,Elm Street,3,6,An Archive\n")
    words: list[object] = ["index", tmp_path / "photos", "--catalogue", listed]
    words += ["-o", tmp_path / "city", "--boards", "none"]
    if own is not None:
        (tmp_path / "own.toml").write_text(own)
        words += ["--profile", tmp_path / "own.toml"]
    assert nostalgin(*words).exit_code == 0
    (tmp_path / "own.toml").unlink(missing_ok=True)  # the city keeps its own
    found = kinds(tmp_path / "city", pictures=False)
    assert (("other lot by its name", False) in found) is told


def test_a_profile_that_was_spoilt_is_grave(tmp_path: Path) -> None:
    sound = city(tmp_path, SOUND, pictures())
    (sound / "profile.toml").write_text("[names]\npatterns = ['(']\n")
    assert kinds(sound) == [("profile", True)]
    (sound / "profile.toml").unlink()  # of a city that was indexed before
    assert kinds(sound) == []


@pytest.mark.parametrize("seed", range(3))
def test_each_hash_is_told_with_the_first_that_it_is_like(seed: int) -> None:
    rng = np.random.default_rng(seed)
    few = rng.integers(0, 2**63, 6, dtype=np.uint64)
    flips = np.uint64(1) << rng.integers(0, 63, 300, dtype=np.uint64)
    codes = few[rng.integers(6, size=300)] ^ flips
    apart = np.bitwise_count(codes[:, None] ^ codes[None]) <= MOST_APART
    first = apart.argmax(axis=1)
    told = [(int(first[at]), at) for at in range(300) if first[at] != at]
    assert likenesses(codes) == told
    assert len(told) == 300 - 6


def test_many_pictures_that_are_alike_are_told_once_each() -> None:
    codes = np.full(20_000, 77, np.uint64)
    assert likenesses(codes) == [(0, at) for at in range(1, 20_000)]
    assert likenesses(codes[:0]) == []


def test_alike_pictures_of_one_size_in_bytes_are_told(tmp_path: Path) -> None:
    painted_so = pictures()
    data = np.frombuffer(painted_so["5_1.png"], np.uint8)
    picture = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE)
    for name, one in (("5_1.png", picture), ("5_2.png", picture // 2 + 20)):
        painted_so[name] = cv2.imencode(".bmp", one)[1].tobytes()
    assert len(painted_so["5_1.png"]) == len(painted_so["5_2.png"])
    assert kinds(city(tmp_path, SOUND, painted_so)) == [("looks the same", False)]


@pytest.mark.parametrize(("pages", "told"), [(1, []), (3, [("several pages", False)])])
def test_pages_that_nobody_reads_are_told(
    tmp_path: Path, pages: int, told: list[tuple[str, bool]]
) -> None:
    painted_so = pictures()
    data = np.frombuffer(painted_so["5_1.png"], np.uint8)
    picture = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE)
    every = [np.roll(picture, 40 * page, axis=1) for page in range(pages)]
    painted_so["5_1.png"] = cv2.imencodemulti(".tif", every)[1].tobytes()
    assert kinds(city(tmp_path, SOUND, painted_so)) == told
