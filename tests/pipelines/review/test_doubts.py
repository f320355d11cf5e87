"""What `index` warned of, and what mends it, on the page."""

import json
from pathlib import Path
from typing import Any

import pytest

from pipelines.index import manifest
from pipelines.review.doubts import Proposal, told
from pipelines.store import Store
from tests.pipelines.review.test_review import HOSTILE, nostalgin, opened, page

HEAD = "photo,block,lot,street,address\n"


def row(lot: int, street: str, number: int, photo: str = "") -> str:
    return f"{photo or f'x_00005_{lot:04}.png'},5,{lot},{street},{number}"


def street(name: str, lots: range, first: int) -> list[str]:
    return [row(lot, name, first + 2 * n) for n, lot in enumerate(lots)]


def indexed(folder: Path, lines: list[str], *more: str) -> Path:
    """Index photographs that nobody can read; those of `more` are on no list."""
    names = [line.split(",")[0] for line in lines]
    (folder / "photos").mkdir()
    for name in {*names, *more}:
        (folder / "photos" / name).write_bytes(b"x")
    (folder / "list.csv").write_text(HEAD + "\n".join(lines) + "\n")
    words = ("--catalogue", folder / "list.csv", "-o", folder / "city")
    done = nostalgin("index", folder / "photos", *words, "--boards", "none")
    assert done.exit_code == 0, done.output
    return folder / "city"


def proposals(city: Path) -> list[Proposal]:
    store = Store(str(city))
    found = told(store, manifest.read(store).rows)
    return [each for one in found.warnings for each in one.proposals]


ELM = street("Elm Street", range(1, 9), 3)
OAK = street("Oak Street", range(9, 17), 99)


def test_of_a_sound_list_nothing_is_told(tmp_path: Path) -> None:
    city = indexed(tmp_path, [*ELM, *OAK])
    assert "What index warned of" not in page(city)


def test_swapped_numbers_may_be_moved_to_where_they_belong(tmp_path: Path) -> None:
    lines = [*ELM[:2], row(3, "Elm Street", 13), *ELM[3:5], row(6, "Elm Street", 7)]
    city = indexed(tmp_path, [*lines, *ELM[6:], *OAK])
    found = {one.subject: one for one in proposals(city)}
    assert found["5-3-0"].values == (("5.5", "13 Elm Street"),)
    assert found["5-6-0"].values == (("1.5", "7 Elm Street"),)
    lines = [
        {"front_id": one.subject, "what": one.what, "value": one.values[0][0]}
        for one in found.values()
    ]
    text = "".join(f"{json.dumps(one)}\n" for one in lines)
    (city / "corrections.jsonl").write_text(text)
    result = nostalgin("corrections", city)
    assert result.exit_code == 0, result.output


def test_what_stands_where_it_is_likeliest_is_not_moved_there(tmp_path: Path) -> None:
    lines = [*ELM[:2], row(3, "Elm Street", 21), *ELM[3:], *OAK]
    (one,) = proposals(indexed(tmp_path, lines))
    assert (one.subject, one.now, one.values) == ("5-3-0", "2", ())


def test_a_photo_named_against_its_name_may_take_its_name_s_lot(tmp_path: Path) -> None:
    lines = [row(1, "Elm Street", 3, "x_00005_0002.png"), *ELM[1:], *OAK]
    (one,) = [
        each for each in proposals(indexed(tmp_path, lines)) if each.of == "photo"
    ]
    assert (one.subject, one.now) == ("x_00005_0002.png", "5-1")
    assert one.values == (("5-2", "its name"),)


def test_unplaced_photographs_are_one_line(tmp_path: Path) -> None:
    strangers = [f"x_00099_{n:04}.png" for n in range(1, 13)]
    text = page(indexed(tmp_path, [*ELM, *OAK], *strangers))
    section = text.partition("What index warned of")[2].partition("</section>")[0]
    (line,) = section.split("<li>")[1:]
    assert line.startswith("12 (x_00099_0001.png, ")
    assert "its block is not on the list: it has 5" in line


def test_hostile_words_of_a_warning_stay_words(tmp_path: Path) -> None:
    slip = row(3, f'"{HOSTILE.replace(chr(34), "")}"', 7)
    text = page(indexed(tmp_path, [*ELM[:2], slip, *ELM[3:], *OAK]))
    assert "alert(1)&gt;" in text
    assert "<img src=x" not in text


@pytest.mark.parametrize("kept", [b"", b"no table"])
def test_a_table_that_is_none_warns_of_nothing(kept: bytes, tmp_path: Path) -> None:
    city = indexed(tmp_path, [*ELM[:2], row(3, "Elm Street", 13), *ELM[3:], *OAK])
    assert "What index warned of" in page(city)
    (city / "warnings.parquet").write_bytes(kept)
    assert "What index warned of" not in page(city)


def test_a_button_writes_the_correction_that_is_proposed(
    browser: Any, tmp_path: Path
) -> None:
    lines = [row(1, "Elm Street", 3, "x_00005_0002.png"), ELM[1], *ELM[3:]]
    city = indexed(tmp_path, [*lines, row(3, "Elm Street", 13), *OAK])
    page(city)
    shown, troubles = opened(browser, city)
    section = shown.locator("section[aria-labelledby=warnings]")
    section.get_by_role("button", name="It is 5-2 (its name)").click()
    section.get_by_label("order of 5-3-0").first.fill("1.5")
    section.get_by_label("note").first.fill("seen on the atlas")
    assert "2 corrections" in shown.locator("#count").inner_text()
    with shown.expect_download() as waiting:
        shown.get_by_role("button", name="Save corrections.jsonl").click()
    waiting.value.save_as(city / "corrections.jsonl")
    assert troubles == []
    shown.close()
    told = [
        json.loads(x) for x in (city / "corrections.jsonl").read_text().splitlines()
    ]
    kinds = {(one["what"], one["value"]) for one in told}
    assert kinds == {("key", "5-2"), ("order", "1.5")}
    result = nostalgin("corrections", city)
    assert result.exit_code == 0, result.output
