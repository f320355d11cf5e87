"""How soon a browser shows a large city, what it draws, and what it keeps in memory.

Baseline: a painted city of three blocks. The clock starts with the page and ends with
the first picture (the page's own mark). Then one walks past a block, flies off, and
comes to another, as often as `STOPS` says: the memory of a page that lets go of what it
has left does not grow with them, which the last line tells as ratios of the second half
of the walk to its first, the most of each. "Tiles" are geometries and textures as a
graphics card would hold them, "buffers" what JavaScript holds beside its heap. Chromium
without a graphics card: times are upper bounds, and on a busy machine ratios alone are
worth something; draw calls, triangles and counts are what any card would get.

    python tests/bench/bench_viewer.py [BUILDINGS]
"""

import os
import sys
import tempfile
import threading
from pathlib import Path
from statistics import median
from typing import Any

from playwright.sync_api import sync_playwright

from pipelines import view
from pipelines.site import site
from tests.bench.bench_tileset import painted_city
from tests.chromium import CHROMIUM, SOFTWARE_GL

BASELINE = 42  # buildings: three blocks
ROUNDS = 3
STOPS = 24
MIB = 2**20
COLUMNS = {
    "calls": "draw calls",
    "triangles": "triangles",
    "walls": "models",
    "kept": "tiles MiB",
    "geometries": "geometries",
    "textures": "textures",
    "heap": "heap MiB",
    "buffers": "buffers MiB",
}
SETTLE = """async () => {
  nostalgin.hold();
  const end = performance.now() + 20000;
  while (performance.now() < end) {
    nostalgin.step(0.01);
    const { downloading, parsing, queued } = nostalgin.page.city.tiles.stats;
    if (!downloading && !parsing && !queued) break;
    await new Promise((done) => setTimeout(done, 60));
  }
  const { tiles } = nostalgin.page.city;
  const { memory } = nostalgin.page.stage.renderer.info;
  const { calls, triangles, walls } = nostalgin.stats;
  const kept = tiles.lruCache.cachedBytes / 2 ** 20;
  return { calls, triangles, walls, kept, ...memory };
}"""


def visited(browser: Any, address: str) -> tuple[Any, float]:
    """Open the page, and wait for its first picture; give the page and seconds."""
    page = browser.new_page(viewport={"width": 640, "height": 480})
    page.set_default_timeout(120_000)
    page.goto(address)
    page.evaluate("nostalgin.ready")
    marked = "performance.getEntriesByName('first picture')[0].startTime"
    return page, page.evaluate(marked) / 1000


def first_pictures(browser: Any, addresses: list[str]) -> list[float]:
    """Take each city's median time to its first picture, by turns."""
    seconds: list[list[float]] = [[] for _ in addresses]
    for _ in range(ROUNDS):
        for own, address in zip(seconds, addresses, strict=True):
            page, took = visited(browser, address)
            own.append(took)
            page.close()
    return [median(own) for own in seconds]


def walked(browser: Any, address: str) -> None:
    """Go from stop to stop through a city, and print what is drawn and kept there."""
    page, _ = visited(browser, address)
    middles = "({ low, high }) => [(low[0] + high[0]) / 2, high[1] + 9]"
    spots = page.evaluate(f"nostalgin.page.city.extents.map({middles})")
    session = page.context.new_cdp_session(page)
    session.send("HeapProfiler.enable")
    print("stop    " + "".join(f"{name:>12}" for name in COLUMNS.values()))
    rows = []
    for stop in range(STOPS):
        x, z = spots[(stop * 97) % len(spots)]
        page.evaluate("nostalgin.setBird(false)")
        page.evaluate(
            "pose => nostalgin.setPose(pose)", {"x": x, "z": z, "yaw": 0, "pitch": 0}
        )
        told(f"{stop + 1:3}", page.evaluate(SETTLE))
        if stop % 4 == 3:  # and up into the air
            page.evaluate("nostalgin.setBird(true)")
            rows.append({**page.evaluate(SETTLE), **held(session)})
            told(f"{stop + 1:3} air", rows[-1])
    half = len(rows) // 2
    ratios = [
        f"{name} {most(rows[half:], key) / max(1, most(rows[:half], key)):.2f} x"
        for key, name in COLUMNS.items()
    ]
    print("second half to first: " + ", ".join(ratios))
    page.close()


def most(rows: list[dict[str, float]], key: str) -> float:
    """Take the most of one column."""
    return max(row[key] for row in rows)


def told(where: str, row: dict[str, float]) -> None:
    """Print a row; what is not measured at every stop stays empty."""
    cells = [f"{row[key]:12,.0f}" if key in row else " " * 12 for key in COLUMNS]
    print(f"{where:8}" + "".join(cells), flush=True)


def held(session: Any) -> dict[str, float]:
    """Measure what JavaScript holds once its garbage is gone, in MiB."""
    session.send("HeapProfiler.collectGarbage")
    usage = session.send("Runtime.getHeapUsage")
    keys = {"heap": "usedSize", "buffers": "backingStorageSize"}
    return {name: usage[key] / MIB for name, key in keys.items() if key in usage}


def main(buildings: int) -> None:
    """Print both cities' first pictures, then a walk through the large one."""
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=str(CHROMIUM), args=SOFTWARE_GL
        )
        addresses, servers = [], []
        for count in (BASELINE, buildings):
            where = Path(folder) / str(count)
            site.assemble(where, blocks=painted_city(count), photos={}, title="")
            servers.append(view.server(where).__enter__())
            threading.Thread(target=servers[-1].serve_forever, daemon=True).start()
            addresses.append(view.address_of(servers[-1]))
        print(f"busy: {os.getloadavg()[0]:.1f} processes want {os.cpu_count()} cores")
        small, large = first_pictures(browser, addresses)
        print(
            f"first picture: {small:.1f} s of {BASELINE} buildings (baseline), ", end=""
        )
        print(f"{large:.1f} s of {buildings}: {large / small:.2f} x")
        walked(browser, addresses[1])
        for one in servers:
            one.shutdown()
            one.server_close()
        browser.close()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
