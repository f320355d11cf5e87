import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from tests.pipelines.told import told_buildings
from tests.viewer.conftest import HOSTILE, Visit

# Block 1's first front, 113-119 West 1 Street, stands on z = 0 and looks south (z > 0).
RADIUS_M = 0.35


@pytest.fixture(autouse=True)
def calm(visit: Visit) -> None:
    visit.ask("nostalgin.hold()")
    visit.ask("nostalgin.setEvidence(false)")
    visit.ask("nostalgin.setBird(false)")
    visit.page.keyboard.press("Escape")


def pixels(visit: Visit) -> np.ndarray:
    """Look at the city alone, without what lies over it."""
    visit.page.add_style_tag(content="body > :not(#view) { opacity: 0 !important }")
    visit.ask("nostalgin.step(0)")
    shot = Image.open(io.BytesIO(visit.page.screenshot(type="png"))).convert("RGB")
    return np.asarray(shot, float)


def coloured(image: np.ndarray) -> np.ndarray:
    return image.max(axis=2) - image.min(axis=2) > 60


def test_every_block_arrives_and_nothing_complains(visit: Visit) -> None:
    stats = visit.ask("nostalgin.stats")
    assert stats["loaded"] == stats["blocks"] == 2
    assert stats["errors"] == []
    missing = [one for one in visit.troubles if "404" not in one]
    assert missing == []


def test_a_block_is_one_mesh_and_the_viewer_paves_its_yards(visit: Visit) -> None:
    # A block that has arrived is shown by one of the next frames.
    meshes = visit.ask("""(async () => { let count = 0;
        for (let frame = 0; frame < 200; frame++) {
            count = 0;
            nostalgin.page.city.tiles.group.traverse(one => { count += one.isMesh ? 1 : 0; });
            if (count >= nostalgin.stats.walls) break;
            nostalgin.step(0);
            await new Promise(done => setTimeout(done, 25));
        }
        return count; })()""")
    assert meshes == visit.ask("nostalgin.stats.walls") == 2


def test_nothing_is_asked_of_another_host(visit: Visit, address: str) -> None:
    elsewhere = [
        url for url in visit.requests if not url.startswith((address, "blob:", "data:"))
    ]
    assert elsewhere == []


def test_the_walk_begins_on_the_street_before_a_front(
    browser: Any, address: str
) -> None:
    fresh = Visit(browser, address).arrive()
    pose = fresh.ask("nostalgin.pose")
    assert pose["z"] > 4.0
    assert fresh.ask("nostalgin.pick(0, 0)")["block"] == "1"
    fresh.page.close()


def test_a_wall_stops_the_walker(visit: Visit) -> None:
    visit.stand(9.0, 9.0, yaw=0.0)
    pose = visit.press("w", seconds=5)
    assert pose["z"] == pytest.approx(RADIUS_M, abs=0.02)
    assert pose["x"] == pytest.approx(9.0, abs=0.02)


def test_the_hurried_walker_is_stopped_too(visit: Visit) -> None:
    visit.stand(9.0, 9.0, yaw=0.0)
    visit.page.keyboard.down("Shift")
    pose = visit.press("w", seconds=5)
    visit.page.keyboard.up("Shift")
    assert pose["z"] == pytest.approx(RADIUS_M, abs=0.02)


def test_a_walker_who_meets_a_wall_aslant_slides_along_it(visit: Visit) -> None:
    visit.stand(9.0, 3.0, yaw=-45.0)
    pose = visit.press("w", seconds=3)
    assert pose["z"] == pytest.approx(RADIUS_M, abs=0.02)
    assert pose["x"] > 13.0


def test_arrow_keys_turn_and_walk(visit: Visit) -> None:
    visit.stand(9.0, 9.0, yaw=0.0)
    assert visit.press("ArrowLeft", seconds=0.5)["yaw"] > 20
    visit.stand(9.0, 9.0, yaw=0.0)
    assert visit.press("ArrowDown", seconds=1)["z"] > 11


def test_stepping_onto_the_kerb_lifts_the_eyes(visit: Visit) -> None:
    visit.stand(9.0, 9.0, yaw=0.0)
    low = visit.ask("nostalgin.pose")["y"]
    high = visit.press("w", seconds=3)["y"]
    assert high - low == pytest.approx(0.15, abs=0.01)


def test_a_click_on_a_building_tells_who_it_is(visit: Visit) -> None:
    visit.stand(9.0, 12.0, yaw=0.0)
    picked = visit.ask("nostalgin.pick(0, 0.1)")
    assert (picked["id"], picked["lot"], picked["block"]) == ("1-1", "1", "1")
    visit.page.mouse.click(320, 220)
    panel = visit.page.locator("#panel")
    assert panel.locator("h2").inner_text() == "115-119 West 1 Street; 2 Second Avenue"
    assert "Lot 1" in panel.inner_text()
    assert "18.0 m (59\u2032 1\u2033)" in panel.inner_text()
    assert "Where you clicked\nPhotographed" in panel.inner_text()
    image = panel.locator("img").first
    image.evaluate("one => one.decode()")
    assert image.evaluate("one => one.naturalWidth") > 100


def test_catalogue_text_stays_text(visit: Visit) -> None:
    visit.ask("nostalgin.select('1-1')")
    assert HOSTILE in visit.page.locator("#panel cite").first.inner_text()
    assert visit.page.locator("h1").inner_text() == HOSTILE
    assert visit.page.locator("img[src='x']").count() == 0
    assert visit.ask("window.hacked === undefined")


def test_long_captions_from_right_to_left_stay_on_the_card(visit: Visit) -> None:
    caption = "שלום רחוב " * 1000
    visit.ask(f"""(() => {{
        const found = nostalgin.page.city.buildings.get("1-1");
        const [photo] = found.record.photos;
        const photos = [{{ ...photo, caption: {json.dumps(caption)}, date: "1940" }}];
        nostalgin.page.panel.show({{ ...found, record: {{ ...found.record, photos }} }});
    }})()""")
    ways = visit.ask("""[...document.querySelectorAll('#panel figcaption > *')]
        .map(one => getComputedStyle(one).direction)""")
    assert ways[0] == "rtl"
    assert ways[-1] == "ltr"
    card = visit.page.locator("#panel")
    box = card.bounding_box()
    assert box["y"] >= 0
    assert box["y"] + box["height"] <= 480
    assert card.evaluate("one => one.scrollWidth <= one.clientWidth")
    assert caption.strip() in card.inner_text()


def test_a_missing_photograph_names_the_remedy(visit: Visit) -> None:
    visit.ask("nostalgin.select('1-7')")
    assert "nostalgin build" in visit.page.locator("#panel figure").inner_text()


def test_an_assumed_building_says_so(visit: Visit) -> None:
    visit.ask("nostalgin.select('1-5')")
    text = visit.page.locator("#panel").inner_text()
    assert "No photograph of this lot could be used" in text
    assert "none of it" in text


def test_e_colours_what_no_camera_saw_and_nothing_else(visit: Visit) -> None:
    # Lot 1 is 18 m wide; a car hid a patch at its foot, a third of the way along.
    visit.stand(9.0, 13.0, yaw=0.0)
    before = pixels(visit)
    visit.page.keyboard.press("e")
    after = pixels(visit)
    front = np.s_[120:320, 160:480]
    assert not coloured(before[front]).any()
    tinted = coloured(after[front])
    assert 0.001 < tinted.mean() < 0.2
    red, _, blue = after[front][tinted].mean(axis=0)
    assert red > 1.5 * blue  # orange: painted in
    untouched = np.abs(after - before).max(axis=2)[front][~tinted]
    assert np.mean(untouched > 4) < 0.02
    assert visit.page.locator("#legend").is_visible()
    visit.page.keyboard.press("e")
    assert np.abs(pixels(visit) - before)[front].max() < 4


def test_the_birds_eye_shows_every_building(visit: Visit) -> None:
    visit.page.keyboard.press("b")
    visit.ask("(() => { for (let i = 0; i < 60; i++) nostalgin.page.step(1/30) })()")
    assert visit.ask("nostalgin.stats.height") == 1
    seen = visit.ask("""(() => { const ids = new Set();
        for (let x = -0.98; x < 1; x += 0.04) for (let y = -0.98; y < 1; y += 0.04) {
            const hit = nostalgin.pick(x, y); if (hit) ids.add(hit.id); }
        return [...ids]; })()""")
    assert len(seen) >= 20  # of 26; the tallest hide a few
    names = visit.ask("nostalgin.page.stage.names.map(one => one.name)")
    assert {"West 1 Street", "West 2 Street", "First Avenue"} <= set(names)
    visit.page.keyboard.press("b")


def test_wheel_and_plus_bring_the_bird_nearer(visit: Visit) -> None:
    visit.ask("nostalgin.setBird(true)")
    far = visit.ask("nostalgin.page.bird.distance")
    visit.page.keyboard.press("+")
    visit.ask("nostalgin.step(0)")
    near = visit.ask("nostalgin.page.bird.distance")
    visit.page.mouse.move(320, 200)
    visit.page.mouse.wheel(0, -100)
    visit.ask(
        "new Promise(done => { const look = () => nostalgin.page.input.zoom"
        " ? done() : setTimeout(look, 20); look(); })"
    )
    visit.ask("nostalgin.step(0)")
    assert far > near > visit.ask("nostalgin.page.bird.distance")


def test_dragging_turns_the_head_and_is_no_click(visit: Visit) -> None:
    visit.stand(9.0, 12.0, yaw=0.0)
    visit.page.mouse.move(300, 220)
    visit.page.mouse.down()
    visit.page.mouse.move(400, 220, steps=4)
    visit.page.mouse.up()
    visit.ask("nostalgin.step(0)")
    assert visit.ask("nostalgin.pose")["yaw"] == pytest.approx(18.3, abs=1.0)
    assert visit.page.locator("#panel").is_hidden()


def test_the_address_bar_shares_the_view(
    visit: Visit, browser: Any, address: str
) -> None:
    visit.stand(12.5, 7.25, yaw=30.0, pitch=5.0)
    visit.ask("nostalgin.setEvidence(true)")
    visit.ask("nostalgin.select('1-4')")
    visit.ask("nostalgin.step(0.5)")
    shared = visit.ask("location.hash")
    other = Visit(browser, f"{address}{shared}").arrive()
    pose = other.ask("nostalgin.pose")
    assert pose["x"] == pytest.approx(12.5, abs=0.06)
    assert pose["z"] == pytest.approx(7.25, abs=0.06)
    assert pose["yaw"] == pytest.approx(30.0, abs=0.06)
    assert other.page.locator("#legend").is_visible()
    assert other.page.locator("#panel h2").inner_text() == "113 West 1 Street"
    other.page.close()


def test_escape_leaves_the_finder_at_once(visit: Visit) -> None:
    visit.page.keyboard.press("g")
    visit.page.keyboard.type("west")
    visit.page.keyboard.press("Escape")
    assert visit.page.locator("#finder").is_hidden()


def test_a_finder_that_is_open_again_does_not_hear_of_its_close(visit: Visit) -> None:
    visit.page.keyboard.press("g")
    late = "document.getElementById('finder').dispatchEvent(new Event('close'))"
    visit.ask(late)  # browsers tell of a close after what one types next
    visit.page.keyboard.type("west")
    visit.page.locator("#finder button", has_text="West 1 Street").first.wait_for()
    visit.page.keyboard.press("Escape")


def test_a_building_is_found_with_keys_alone(visit: Visit) -> None:
    visit.page.keyboard.press("g")
    visit.page.keyboard.type("2 lot 17")
    visit.page.keyboard.press("Enter")  # perhaps before the list has come
    visit.page.locator("#panel h2", has_text="110-112 West 2 Street").wait_for()
    facing = visit.ask("nostalgin.pick(0, 0)")
    assert facing["lot"] == "17"
    focused = visit.ask("document.activeElement.getAttribute('aria-label')")
    assert focused == "Close"
    visit.page.keyboard.press("Escape")
    assert visit.page.locator("#panel").is_hidden()


def test_a_cross_marks_the_middle_for_who_cannot_point_alone(visit: Visit) -> None:
    cross = visit.page.locator("#cross")
    shown = []
    for state in ("", "locked", "keys"):
        visit.ask("document.body.classList.remove('locked', 'keys')")
        if state:
            visit.ask(f"document.body.classList.add('{state}')")
        shown.append(cross.is_visible())
    visit.ask("document.body.classList.remove('keys')")
    assert shown == [False, True, True]


def test_a_folder_without_a_city_names_the_remedy(browser: Any, address: str) -> None:
    page = browser.new_page()
    page.route("**/site.json", lambda route: route.fulfill(status=404))
    page.goto(address)
    page.get_by_text("nostalgin build CITY").wait_for()
    page.close()


def test_the_site_names_only_what_it_holds(folder: Path) -> None:
    record = json.loads((folder / "site.json").read_text())
    for block in record["blocks"]:
        assert (folder / block["uri"]).is_file()
    for building in told_buildings(folder):
        for photo in building["photos"]:
            assert photo["file"] is None or (folder / photo["file"]).is_file()
