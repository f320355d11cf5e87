"""Records come with their models, when they are needed, and may be spoilt."""

import json
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from pipelines import view
from pipelines.site import site
from tests.viewer.conftest import Visit, model

APART_M = 2000.0


@pytest.fixture(scope="module")
def wide(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A city of three blocks, of which nobody sees more than one at a time."""
    folder = tmp_path_factory.mktemp("wide") / "site"
    where = enumerate(("1", "2", "3"))
    blocks = [model(name, (APART_M * number, 0.0)) for number, name in where]
    site.assemble(folder, blocks=blocks, photos={}, title="Wide")
    return folder


@pytest.fixture
def served() -> Iterator[Any]:
    """Serve folders, each at an address of its own."""
    servers = []

    def serve(folder: Path) -> str:
        running = view.server(folder)
        servers.append(running)
        threading.Thread(target=running.serve_forever, daemon=True).start()
        return view.address_of(running)

    yield serve
    for one in servers:
        one.shutdown()
        one.server_close()


def headers(folder: Path) -> list[dict[str, Any]]:
    return json.loads((folder / "site.json").read_text())["blocks"]


def asked_for(visit: Visit, folder: str) -> list[str]:
    return [url for url in visit.requests if f"/{folder}/" in url]


def test_the_first_picture_needs_only_the_record_of_what_is_near(
    browser: Any, wide: Path, served: Any
) -> None:
    visit = Visit(browser, served(wide))
    visit.ask("nostalgin.ready")
    visit.ask("nostalgin.hold()")
    first, *others = (one["record"] for one in headers(wide))
    assert [url.rpartition("records/")[2] for url in asked_for(visit, "records")] == [
        first.removeprefix("records/")
    ]
    assert asked_for(visit, "finder") == []
    ids = visit.ask("[...nostalgin.page.city.buildings.keys()]")
    assert ids
    assert all(one.startswith("1-") for one in ids)
    assert visit.ask("nostalgin.page.finder.count") == 3 * len(ids)
    assert len(others) == 2
    visit.page.close()


def test_a_link_to_what_is_far_needs_only_its_own_record(
    browser: Any, wide: Path, served: Any
) -> None:
    visit = Visit(browser, f"{served(wide)}#building=3-17")
    visit.ask("nostalgin.ready")
    (record,) = {url.rpartition("/")[2] for url in asked_for(visit, "records")}
    assert record.startswith("3-")
    assert asked_for(visit, "finder") == []
    assert "West 2 Street" in visit.page.locator("#panel h2").inner_text()
    until(visit, "nostalgin.page.faces() === '3-17'")
    visit.page.close()


def test_the_finder_leads_to_a_block_that_was_never_near(
    browser: Any, wide: Path, served: Any
) -> None:
    visit = Visit(browser, served(wide))
    visit.ask("nostalgin.ready")
    visit.page.keyboard.press("g")
    visit.page.keyboard.type("2, lot 17")
    visit.page.keyboard.press("Enter")  # before the list has come
    visit.page.locator("#panel h2", has_text="West 2 Street").wait_for()
    assert len(asked_for(visit, "finder")) == 1
    until(visit, "nostalgin.page.faces() === '2-17'")
    assert visit.ask("nostalgin.page.finder.rows.length") == 0  # let go of
    visit.page.close()


def until(visit: Visit, true: str) -> None:
    """Wait until something holds; fail after twenty seconds."""
    held = visit.ask(f"""new Promise(done => {{ const end = performance.now() + 20000;
        const look = () => ({true}) ? done(true)
            : performance.now() > end ? done(false) : setTimeout(look, 50);
        look(); }})""")
    assert held, true


def test_no_model_enters_before_its_record(
    browser: Any, wide: Path, served: Any
) -> None:
    page = browser.new_page(viewport={"width": 640, "height": 480})
    held: list[Any] = []
    page.route("**/records/**", lambda route: held.append(route))  # noqa: PLW0108
    with page.expect_response("**/blocks/1-*.glb"):
        page.goto(served(wide))
    page.wait_for_timeout(1500)
    assert held
    assert page.evaluate("document.body.classList.contains('running')") is False
    for one in held:
        one.continue_()
    page.unroute("**/records/**")
    page.evaluate("nostalgin.ready")
    assert page.evaluate("nostalgin.stats.walls") == 1
    shapes = "[...nostalgin.page.city.buildings.values()].filter(({shape}) => shape)"
    assert page.evaluate(f"{shapes}.length") == page.evaluate(
        "nostalgin.page.city.buildings.size"
    )
    page.close()


@pytest.mark.parametrize("how", ["gone", "cut", "empty"])
@pytest.mark.parametrize("which", [0, 1])
def test_a_record_that_is_spoilt_is_named_and_the_other_blocks_are_shown(
    browser: Any, wide: Path, served: Any, how: str, which: int
) -> None:
    folder = wide.parent / f"{how}-{which}"
    shutil.copytree(wide, folder)
    header = headers(folder)[which]
    path = folder / header["record"]
    if how == "gone":
        path.unlink()
    else:
        path.write_bytes(path.read_bytes()[:100] if how == "cut" else b"{}")
    visit = Visit(browser, served(folder))
    visit.ask("nostalgin.ready")
    other = "2" if which == 0 else "1"
    assert visit.ask("[...nostalgin.page.city.standing.keys()][0].name") == other
    if which == 1:
        visit.ask("nostalgin.page.guide.seek('2-17')")
    place = visit.page.locator("#place")
    visit.page.locator("#place", has_text=header["record"]).wait_for()
    assert "nostalgin build" in place.inner_text()
    visit.ask("nostalgin.page.guide.seek('3-17', {show: true})")
    visit.page.locator("#panel h2", has_text="West 2 Street").wait_for()
    visit.page.close()


def test_a_city_of_an_earlier_version_names_the_remedy(
    browser: Any, wide: Path, served: Any, tmp_path: Path
) -> None:
    folder = tmp_path / "site"
    shutil.copytree(wide, folder)
    told = json.loads((folder / "site.json").read_text())
    for block in told["blocks"]:
        record = json.loads((folder / block.pop("record")).read_text())
        block["buildings"] = record["buildings"]
    (folder / "site.json").write_text(json.dumps(told))
    page = browser.new_page()
    page.goto(served(folder))
    page.get_by_text("earlier version").wait_for()
    assert "nostalgin build CITY" in page.locator("#notice").inner_text()
    page.close()


def test_a_list_that_is_gone_is_named(
    browser: Any, wide: Path, served: Any, tmp_path: Path
) -> None:
    folder = tmp_path / "site"
    shutil.copytree(wide, folder)
    shutil.rmtree(folder / "finder")
    visit = Visit(browser, served(folder))
    visit.ask("nostalgin.ready")
    visit.page.keyboard.press("g")
    visit.page.locator("#finder p", has_text="nostalgin build").wait_for()
    visit.page.keyboard.press("Escape")
    assert visit.ask("nostalgin.page.walker.pose.x") is not None
    visit.page.close()


def test_the_tour_leads_to_blocks_of_which_nothing_was_known(
    browser: Any, folder: Path, served: Any, tmp_path: Path
) -> None:
    far = tmp_path / "site"
    shutil.copytree(folder, far)
    told = json.loads((far / "site.json").read_text())
    told["tour"] = [one for one in told["tour"] if one["block"] == "2"]
    (far / "site.json").write_text(json.dumps(told))
    visit = Visit(browser, served(far))
    visit.ask("nostalgin.ready")
    visit.page.keyboard.press("r")
    until(visit, "nostalgin.page.chosen?.startsWith('2-')")
    assert visit.page.locator("#tour p").inner_text().startswith("1 of ")
    visit.page.close()
