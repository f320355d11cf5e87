"""Then-view, links, the tour and credits, in a real browser."""

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from tests.viewer.conftest import RECORD, Visit

CORNERS = """(() => {
    const {page} = nostalgin, {camera} = page.stage;
    const {shape, record} = page.city.buildings.get('1-1');
    const wall = shape.walls.find(({out}) => out[1] > 0.99); // it looks south
    const box = document.getElementById('picture').getBoundingClientRect();
    const photo = record.photos.find(({key}) => key === page.guide.then.key).camera;
    const at = ([x, z], y) => {
        const p = camera.position.clone().set(x, y, z).project(camera);
        return [(p.x + 1) / 2 * innerWidth, (1 - p.y) / 2 * innerHeight];
    };
    const {a, b, top} = wall;
    return {
        model: [at(a, top), at(b, top), at(b, 0), at(a, 0)],
        quad: photo.quad_px.map(([x, y]) => [
            box.x + (x + 0.5) / photo.size_px[0] * box.width,
            box.y + (y + 0.5) / photo.size_px[1] * box.height,
        ]),
    };
})()"""


@pytest.fixture(autouse=True)
def calm(visit: Visit) -> Iterator[None]:
    visit.ask("nostalgin.hold()")
    visit.ask("nostalgin.setEvidence(false); nostalgin.setBird(false)")
    visit.ask("nostalgin.page.guide.moved(); nostalgin.page.panel.close()")
    arrive(visit)
    yield
    visit.ask("nostalgin.page.guide.moved(); nostalgin.page.panel.close()")


def arrive(visit: Visit) -> None:
    """Fly wherever one flies to."""
    visit.ask("nostalgin.step(3); nostalgin.step(0.5)")


def test_the_painted_quad_and_the_model_coincide(visit: Visit) -> None:
    visit.ask("nostalgin.page.guide.enter('1-1')")
    arrive(visit)
    assert visit.page.locator("#picture").is_visible()
    found = visit.ask(CORNERS)
    off = np.hypot(*np.subtract(found["model"], found["quad"]).T)
    assert off.max() < 1.0  # of a screen of 640 by 480


def test_the_quad_stays_on_the_model_when_the_window_changes(visit: Visit) -> None:
    visit.ask("nostalgin.page.guide.enter('1-1')")
    arrive(visit)
    visit.page.set_viewport_size({"width": 420, "height": 640})
    visit.ask("new Promise(requestAnimationFrame)")
    arrive(visit)
    found = visit.ask(CORNERS)
    visit.page.set_viewport_size({"width": 640, "height": 480})
    assert np.abs(np.subtract(found["model"], found["quad"])).max() < 1.0


def test_the_slider_leads_from_then_to_the_model_with_keys_alone(visit: Visit) -> None:
    visit.ask("nostalgin.select('1-1')")
    visit.page.keyboard.press("t")
    arrive(visit)
    share = visit.page.locator("#share")
    share.focus()
    visit.page.keyboard.press("Home")
    assert visit.ask("document.querySelector('#picture img').style.opacity") == "0"
    visit.page.keyboard.press("End")
    assert visit.ask("document.querySelector('#picture img').style.opacity") == "1"
    assert "give or take" in visit.page.locator("#then p").inner_text()
    visit.ask("nostalgin.page.panel.close()")
    visit.page.keyboard.press("t")
    arrive(visit)
    assert visit.page.locator("#picture").is_hidden()
    assert visit.page.locator("#then").is_hidden()


def test_whoever_walks_leaves_the_photograph(visit: Visit) -> None:
    visit.ask("nostalgin.page.guide.enter('1-1')")
    arrive(visit)
    visit.press("w", seconds=0.2)
    assert visit.page.locator("#picture").is_hidden()
    assert visit.ask("nostalgin.page.guide.then.on") is False


def test_a_link_names_the_photograph(visit: Visit, browser: Any, address: str) -> None:
    visit.ask("nostalgin.page.guide.enter('1-1')")
    arrive(visit)
    link = visit.ask("location.hash")
    assert "then=photo-1-1" in link
    other = Visit(browser, f"{address}{link}").arrive()
    arrive(other)
    assert other.ask("nostalgin.page.guide.then.key") == "photo-1-1"
    assert np.abs(np.subtract(*other.ask(CORNERS).values())).max() < 1.0
    other.page.close()


def test_a_link_with_a_building_alone_leads_before_it(
    browser: Any, address: str
) -> None:
    fresh = Visit(browser, f"{address}#building=2-17").arrive()
    assert fresh.ask("nostalgin.page.faces()") == "2-17"
    fresh.ask("location.hash = '#building=1-4'")
    fresh.ask("new Promise(done => setTimeout(done, 100))")
    assert fresh.ask("nostalgin.page.faces()") == "1-4"
    assert fresh.page.locator("#panel h2").inner_text() == "113 West 1 Street"
    fresh.ask("location.hash = '#building=9-9'")
    fresh.ask("new Promise(done => setTimeout(done, 100))")
    assert "no building 9-9" in fresh.page.locator("#place").inner_text()
    fresh.page.close()


@pytest.mark.parametrize("link", ["#993-12", "#building=9-9", "#at=1,2,3"])
def test_a_link_that_leads_nowhere_begins_where_the_city_does(
    browser: Any, address: str, link: str
) -> None:
    plain, lost = (Visit(browser, f"{address}{end}").arrive() for end in ("", link))
    assert lost.ask("nostalgin.pose") == plain.ask("nostalgin.pose")
    for one in (plain, lost):
        one.page.close()


def test_what_is_faced_is_named_and_seen_whole(visit: Visit) -> None:
    ids = visit.ask("[...nostalgin.page.city.buildings.keys()]")
    faced = [
        visit.ask(f"nostalgin.page.guide.visit('{one}') && nostalgin.page.faces()")
        for one in ids
    ]
    assert faced == ids
    visit.ask("nostalgin.page.guide.visit('1-9')")  # the tallest, nine storeys
    visit.ask("nostalgin.page.said = 1; nostalgin.page.quiet = 0; nostalgin.step(0)")
    assert "101-103 West 1 Street" in visit.page.locator("#place").inner_text()
    rim = visit.ask("""(() => {
        const {page} = nostalgin, {camera} = page.stage;
        const {shape} = page.city.buildings.get('1-9');
        const yaw = page.walker.pose.yaw * Math.PI / 180;
        const wall = shape.walls.find(({out}) =>
            out[0] * Math.sin(yaw) + out[1] * Math.cos(yaw) > 0.99);
        return [wall.a, wall.b].flatMap(([x, z]) => [0, wall.top].map(y => {
            const p = camera.position.clone().set(x, y, z).project(camera);
            return Math.max(Math.abs(p.x), Math.abs(p.y)); }));
    })()""")
    assert max(rim) <= 1


def test_the_tour_goes_from_front_to_front_until_somebody_walks(visit: Visit) -> None:
    visit.page.keyboard.press("r")
    arrive(visit)
    words = visit.page.locator("#tour p")
    first = words.inner_text()
    assert re.match(r"1 of 12: ", first)
    visit.ask("nostalgin.step(8); nostalgin.step(3)")
    assert words.inner_text().startswith("2 of 12: ")
    visit.page.locator("#tour [data-act=pause]").click()
    visit.ask("nostalgin.step(30)")
    assert words.inner_text().startswith("2 of 12: ")
    visit.press("w", seconds=0.1)
    assert visit.page.locator("#tour").is_hidden()


def test_credit_and_record_are_always_on_the_page(visit: Visit) -> None:
    visit.ask("nostalgin.select('1-4'); nostalgin.page.said = 1; nostalgin.step(0)")
    credit = visit.page.locator("#credit")
    assert credit.is_visible()
    assert "about 1940" in credit.inner_text()
    link = credit.locator("a")
    assert link.get_attribute("href") == f"{RECORD}/photo-1-4"
    assert "noopener" in str(link.get_attribute("rel"))


def test_p_saves_a_picture(visit: Visit) -> None:
    with visit.page.expect_download() as saving:
        visit.page.keyboard.press("p")
    assert re.fullmatch(r"[\w-]+\.png", saving.value.suggested_filename)


def test_things_drawn_for_scale_stand_about_and_are_owned_up_to(visit: Visit) -> None:
    visit.stand(9.0, 9.0, yaw=0.0)
    visit.ask("nostalgin.step(0)")
    counts = visit.ask("""Object.fromEntries(Object.entries(
        nostalgin.page.stage.props.kinds).map(([kind, {count}]) => [kind, count]))""")
    assert min(counts[kind] for kind in ("lamp", "car", "figure")) > 0
    visit.ask("nostalgin.setEvidence(true)")
    legend = visit.page.locator("#legend").inner_text()
    assert "lamp posts and cars" in legend
    visit.ask("nostalgin.page.guide.enter('1-1')")
    arrive(visit)
    assert visit.ask("nostalgin.page.stage.props.group.visible") is False


def test_every_control_has_a_name_and_every_id_is_one_of_its_kind(visit: Visit) -> None:
    visit.ask("nostalgin.select('1-1')")
    nameless = visit.ask("""[...document.querySelectorAll('button, input, a[href], [role]')]
        .filter(one => !(one.getAttribute('aria-label') || one.textContent.trim()
            || one.getAttribute('aria-labelledby') || one.getAttribute('title')
            || one.labels?.length || one.querySelector('img[alt]')))
        .map(one => one.outerHTML)""")
    assert [one for one in nameless if 'role="status"' not in one] == []
    twice = visit.ask("""(() => { const ids = [...document.querySelectorAll('[id]')].map(e => e.id);
        return ids.filter((id, i) => ids.indexOf(id) !== i); })()""")
    assert twice == []
    assert visit.ask("[...document.images].every(one => one.hasAttribute('alt'))")


def test_words_stand_out_from_their_paper(visit: Visit) -> None:
    ratio = visit.ask("""(() => {
        const style = getComputedStyle(document.documentElement);
        const light = (name) => { const hex = style.getPropertyValue(name).trim();
            const [r, g, b] = [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16) / 255)
                .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
            return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
        const paper = light('--paper') + 0.05;
        return ['--ink', '--faint', '--accent'].map(name => paper / (light(name) + 0.05)); })()""")
    assert min(ratio) >= 4.5  # WCAG AA
