from typing import Any

from tests.viewer.conftest import Visit

# Nothing is kept that is not drawn; then one goes where the city can't be seen, and back.
SPARING = """Object.assign(nostalgin.page.city.tiles.lruCache,
    { minSize: 0, minBytesSize: 0 })"""
GO = """async ({ x, wanted }) => {
    nostalgin.setPose({ x, z: 12, yaw: 0, pitch: 0 });
    nostalgin.setBird(wanted > 0);
    const end = performance.now() + 20000;
    while (nostalgin.stats.walls !== wanted && performance.now() < end) {
        nostalgin.step(0.01);
        await new Promise(done => setTimeout(done, 20));
    }
    nostalgin.step(0.01);
    const { city, stage } = nostalgin.page;
    const { geometries, textures } = stage.renderer.info.memory;
    return { geometries, textures, walls: city.walls.size, names: stage.names.length,
        shapes: [...city.buildings.values()].filter(({ shape }) => shape).length,
        bytes: city.tiles.lruCache.cachedBytes };
}"""
AWAY_M = 30_000.0


def went(visit: Visit, x: float, wanted: int) -> dict[str, float]:
    return visit.page.evaluate(GO, {"x": x, "wanted": wanted})


def test_what_one_leaves_is_let_go_and_comes_again(browser: Any, address: str) -> None:
    visit = Visit(browser, address).arrive()
    visit.ask(SPARING)
    rounds = [(went(visit, 5.0, 2), went(visit, AWAY_M, 0)) for _ in range(2)]
    (here, away), again = rounds
    assert here["shapes"]
    assert here["names"] >= 3
    assert (away["walls"], away["names"], away["shapes"], away["bytes"]) == (0, 0, 0, 0)
    assert away["textures"] < here["textures"]
    assert again == (here, away)
    visit.page.close()


def test_evidence_counts_in_the_bytes_that_are_kept(visit: Visit) -> None:
    kept, pictures = visit.ask("""(() => {
        const { city } = nostalgin.page;
        const sizes = [...city.walls].flatMap(({ material, userData }) =>
            [[material.map, 4 / 3], [userData.evidence, 1]].filter(([map]) => map)
                .map(([{ image }, more]) => 4 * more * image.width * image.height));
        return [city.tiles.lruCache.cachedBytes, sizes.reduce((a, b) => a + b, 0)];
    })()""")
    assert pictures > 0
    assert pictures <= kept < 1.5 * pictures


def test_a_name_left_out_for_a_neighbours_comes_when_that_goes(visit: Visit) -> None:
    told = visit.ask("""(() => {
        const { signs } = nostalgin.page.stage;
        const row = [{ a: [900, 900], b: [940, 900], out: [0, 1] }];
        const of = () => signs.planes.filter(({ name }) => name === 'New Lane')
            .map(({ userData }) => userData.block);
        const steps = [];
        signs.write('one', 'New Lane', row); signs.write('two', 'New Lane', row);
        signs.write('one', 'New Lane', row); steps.push(of());
        signs.erase('one'); steps.push(of());
        signs.erase('two'); steps.push(of());
        return [steps, signs.paper.has('New Lane'),
            signs.unwritten.some(({ name }) => name === 'New Lane')];
    })()""")
    assert told == [[["one"], ["two"], []], False, False]
