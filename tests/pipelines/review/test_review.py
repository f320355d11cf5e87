"""The page of a city: what it shows, what it hides from harm, and what it saves."""

import json
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner, Result

from pipelines import review
from pipelines.cli import app
from pipelines.corrections import shapes
from pipelines.store import Store
from tests.pipelines.cities import copied

HOSTILE = "<img src=x onerror=alert(1)>\"'</script><script>alert(2)</script>"
PNG = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108000000003a7e9b55"
    "0000000a49444154789c6360000000020001e221bc330000000049454e44ae426082"
)


def nostalgin(*words: object) -> Result:
    return CliRunner().invoke(app, [str(word) for word in words])


def read(city: Path, **cells: Any) -> None:
    row = {"photo": "5_1.png", "verdict": "contradicted", "board_says": "5 - 2 M"}
    row |= {"read_block": "5", "read_lot": "2", "name_says": "5-1", "score": 0.93}
    pq.write_table(pa.Table.from_pylist([row | cells]), city / "readings.parquet")


def page(city: Path, *words: object) -> str:
    result = nostalgin("review", city, *words)
    assert result.exit_code == 0, result.output
    return (city / "review.html").read_text()


def test_a_city_that_was_not_built_and_not_read_has_a_page(
    city: Path, tmp_path: Path
) -> None:
    text = page(copied(city, tmp_path))
    assert text.count('<article class="photo"') == 4
    assert "rights missing" in text


def test_crops_stand_beside_readings_with_all_that_is_said(other: Path) -> None:
    (other / "readings").mkdir()
    (other / "readings" / "x.png").write_bytes(PNG)
    read(other, crop="readings/x.png", list_says="5-1; 6-1", remedy="look at it")
    text = page(other)
    assert "data:image/png;base64," in text
    assert text.index('data-photo="5_1.png"') < text.index('data-photo="5_2.jpg"')
    for key in ("5-2", "5-1", "6-1"):
        assert f'data-take="{key}"' in text
    assert "93 %" in text


@pytest.mark.parametrize(
    "crop", ["../../secret.png", "/etc/hostname", "manifest.csv", "none.png"]
)
def test_a_crop_is_a_picture_within_the_city(other: Path, crop: str) -> None:
    (other.parent.parent / "secret.png").write_bytes(PNG)
    read(other, crop=crop)
    assert 'class="crop"' not in page(other)


def test_crops_are_read_of_the_photographs_that_are_shown_alone(
    other: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (other / "readings").mkdir()
    names = ("5_1.png", "5_2.jpg")
    for name in names:
        (other / "readings" / f"{name}.png").write_bytes(PNG)
    rows = [
        {"photo": name, "verdict": "contradicted", "crop": f"readings/{name}.png"}
        for name in names
    ]
    pq.write_table(pa.Table.from_pylist(rows), other / "readings.parquet")
    asked: list[str] = []
    read_bytes = Store.read_bytes

    def noted(store: Store, name: str, *most: int) -> bytes:
        asked.append(name)
        return read_bytes(store, name, *most)

    monkeypatch.setattr(Store, "read_bytes", noted)
    found = review.review(Store(str(other)), most=1)
    assert found.verdicts == {"contradicted": 2}
    assert [one for one in asked if one.startswith("readings/")] == [
        f"readings/{one.name}.png" for one in found.pictures
    ]


def test_a_table_that_is_none_is_taken_for_none(other: Path) -> None:
    (other / "readings.parquet").write_bytes(b"no table")
    assert "<dt>verdict" not in page(other)


def test_hostile_words_stay_words(other: Path) -> None:
    read(other, board_says=HOSTILE, remedy=HOSTILE, verdict=HOSTILE)
    (other / "corrections.jsonl").write_text(json.dumps({"what": HOSTILE}) + "\n")
    text = page(other)
    assert HOSTILE not in text
    assert text.count("<script") == 1
    assert "<img src=x" not in text


def test_photos_beyond_the_most_are_counted(other: Path) -> None:
    text = page(other, "--most", 1)
    assert text.count('<article class="photo"') == 1
    assert "3 more are not shown" in text
    assert page(other, "--block", 6).count('<article class="photo"') == 1


def test_a_block_that_is_not_there_is_told(other: Path) -> None:
    result = CliRunner().invoke(app, ["review", str(other), "--block", "12345"])
    assert result.exit_code == 1
    assert "has no block '12345': its first are 5, 6" in result.output


def test_a_quiet_one_writes_the_page_alone_and_tells_nothing(other: Path) -> None:
    before = {path for path in other.rglob("*") if path.is_file()}
    assert nostalgin("review", other, "--quiet").output == ""
    fresh = {path for path in other.rglob("*") if path.is_file()} - before
    assert fresh == {other / "review.html"}


def test_a_folder_without_a_manifest_is_told(tmp_path: Path) -> None:
    result = nostalgin("review", tmp_path)
    assert result.exit_code == 1
    assert "nostalgin index" in " ".join(result.output.split())


@pytest.mark.parametrize(
    ("data", "size", "told"),
    [
        (b'{"note": "caf\xe9"}\n', 0, "byte 14 is not UTF-8; save it as UTF-8"),
        (b"{}\n", 50_000_001, "Larger than the 50,000,000 bytes that are read; move"),
    ],
)
def test_no_page_is_written_that_would_lose_earlier_corrections(
    data: bytes, size: int, told: str, other: Path
) -> None:
    given = other / "corrections.jsonl"
    given.write_bytes(data)
    with given.open("r+b") as file:
        file.truncate(max(size, len(data)))
    result = nostalgin("review", other)
    assert result.exit_code == 1
    assert f"corrections.jsonl: {told}" in " ".join(result.output.split())
    assert not (other / "review.html").exists()


def opened(browser: Any, city: Path) -> tuple[Any, list[str]]:
    """Open the page; gather all that goes wrong, and all that it asks a network for."""
    shown = browser.new_page(viewport={"width": 1000, "height": 900})
    troubles: list[str] = []
    asked: list[str] = []
    shown.on("console", lambda one: troubles.append(one.text))
    shown.on("pageerror", lambda one: troubles.append(str(one)))
    shown.on("request", lambda one: asked.append(one.url))
    shown.goto((city / "review.html").as_uri())
    assert [one for one in asked if one.startswith("http")] == []
    return shown, troubles


def test_what_the_form_saves_is_accepted_as_it_is(browser: Any, other: Path) -> None:
    read(other, board_says=HOSTILE)
    given = {"what": "height_m", "building_id": "5-2", "value": "14"}
    (other / "corrections.jsonl").write_text(json.dumps(given))
    page(other)
    shown, troubles = opened(browser, other)
    card = shown.locator('article[data-photo="5_1.png"]')
    corner = card.locator(".quad circle").first
    before = shapes.read(card.locator(".quad polygon").get_attribute("points"))
    corner.scroll_into_view_if_needed()
    box = corner.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    shown.mouse.move(x, y)
    shown.mouse.down()
    shown.mouse.move(x + 10, y + 14, steps=4)
    shown.mouse.up()
    card.locator(".mask circle").nth(1).focus()
    shown.keyboard.press("Shift+ArrowLeft")
    card.locator("button[data-take='5-2']").click()
    card.get_by_label("width of 5-1-0, m").fill("9.5")
    card.get_by_label("note").fill("by\u2028eye\u2029\x85")
    assert "4 corrections" in shown.locator("#count").inner_text()
    with shown.expect_download() as waiting:
        shown.get_by_role("button", name="Save corrections.jsonl").click()
    assert waiting.value.suggested_filename == "corrections.jsonl"
    waiting.value.save_as(other / "corrections.jsonl")
    assert troubles == []
    shown.close()
    lines = (other / "corrections.jsonl").read_text().splitlines()
    told = [json.loads(line) for line in lines]  # also those of programs that cut more
    assert told[0] == given
    assert {one["note"] for one in told[1:]} == {"by\u2028eye\u2029\x85"}
    kinds = sorted(one["what"] for one in told)
    assert kinds == ["height_m", "key", "mask", "quad", "width_m"]
    after = shapes.read(next(one["value"] for one in told if one["what"] == "quad"))
    moved = after - before
    assert moved[0].min() > 2
    assert abs(moved[1:]).max() < 0.11
    result = nostalgin("corrections", other)
    assert result.exit_code == 0, result.output
    assert "5 corrections, 0 rejected" in " ".join(result.output.split())


def test_the_page_is_used_by_keys_alone_and_names_its_fields(
    browser: Any, other: Path
) -> None:
    page(other)
    shown, troubles = opened(browser, other)
    unnamed = """() => Array.from(
        document.querySelectorAll("input, circle, button, img, svg"))
        .filter((one) => !(one.labels && one.labels.length) && !one.textContent.trim()
            && !one.getAttribute("aria-label") && !one.getAttribute("alt")).length"""
    twice = """() => {
        const ids = Array.from(document.querySelectorAll("[id]"), (one) => one.id);
        return ids.length - new Set(ids).size; }"""
    assert (shown.evaluate(unnamed), shown.evaluate(twice)) == (0, 0)
    assert shown.locator("html").get_attribute("lang") == "en"
    assert shown.locator("h1").count() == 1
    first = shown.locator("article").first
    first.locator(".mask circle").first.focus()
    count = first.locator(".mask circle").count()
    shown.keyboard.press("Insert")
    assert first.locator(".mask circle").count() == count + 1
    shown.keyboard.press("Delete")
    assert first.locator(".mask circle").count() == count
    first.get_by_role("button", name="Draw the quad anew").press("Enter")
    focused = shown.evaluate("document.activeElement.getAttribute('aria-label')")
    assert focused.startswith("corner 1 of 4 of the quad")
    assert troubles == []
    shown.close()
