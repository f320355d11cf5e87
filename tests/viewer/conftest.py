"""A painted site, a server for it, and a real browser that walks in it."""

import json
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from nostalgin_core.records import Standpoint
from pipelines import view
from pipelines.site import site
from pipelines.site.record import record
from tests.core import sample_block

HOSTILE = '<img src=x onerror="window.hacked=1"> & <b>Archive</b>'
WITHOUT_PICTURE = "photo-1-7"
RECORD = "https://archive.example/plate"


def stood(width_m: float, height_m: float) -> Standpoint:
    """Paint a quad: a camera 1.6 m high, 20 m off, before the left third, tilted up."""
    tilt, turn = np.radians([8.0, -12.0])
    up = np.array(
        [[1, 0, 0], [0, np.cos(tilt), np.sin(tilt)], [0, -np.sin(tilt), np.cos(tilt)]]
    )
    round_ = np.array(
        [[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]]
    )
    front_from_camera = np.diag([1.0, -1.0, -1.0]) @ round_ @ up
    lens = np.array([[640.0, 0, 305.0], [0, 640.0, 390.0], [0, 0, 1]])
    roof = height_m / width_m
    position = np.array([0.3, 1.6 / width_m, 20.0 / width_m])
    corners = np.array([[0, roof, 0], [1, roof, 0], [1, 0, 0], [0, 0, 0]])
    seen = (corners - position) @ front_from_camera @ lens.T
    return Standpoint(
        size_px=(600, 800),
        photo_from_camera=lens,
        focal_sd=0.1,
        position=(0.3, 1.6 / width_m, 20.0 / width_m),
        position_sd=0.1,
        front_from_camera=front_from_camera,
        quad_px=seen[:, :2] / seen[:, 2:],
        roof=roof,
    )


def model(name: str, origin_m: tuple[float, float]) -> site.BlockModel:
    block, glb = sample_block.built(name)
    photos = {
        one.photo: {
            "credit": HOSTILE,
            "caption": f"Plate {one.photo}",
            "source_url": f"{RECORD}/{one.photo}",
            "date": "about 1940",
        }
        for one in sample_block.assignments(name)
    }
    known = record(
        block,
        fronts=sample_block.fronts(name),
        assignments=sample_block.assignments(name),
        seen=sample_block.seen(name),
        stood={
            wall.texture: stood(
                float(np.hypot(*np.subtract(wall.end_m, wall.start_m))), one.height_m
            )
            for one in block.buildings
            for wall in one.walls
            if wall.texture and wall.evidence is None
        },
        photos=photos,
    )
    low, high = sample_block.bounds(block)
    return site.BlockModel(name, glb, known, low, high, origin_m)


def thumbnails() -> dict[str, bytes]:
    return {
        photo: site.thumbnail(elevation.image)
        for name in ("1", "2")
        for (photo, _), elevation in sample_block.elevations(name).items()
        if photo != WITHOUT_PICTURE
    }


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if not (site.VIEWER / "index.html").is_file():
        pytest.skip(f"no viewer at {site.VIEWER}: build it with `make viewer`")
    folder = tmp_path_factory.mktemp("city") / "site"
    site.assemble(
        folder,
        blocks=[model("1", (0.0, 0.0)), model("2", (0.0, 90.0))],
        photos=thumbnails(),
        title=HOSTILE,
    )
    return folder


@pytest.fixture(scope="session")
def address(folder: Path) -> Iterator[str]:
    with view.server(folder) as running:
        threading.Thread(target=running.serve_forever, daemon=True).start()
        yield view.address_of(running)
        running.shutdown()


class Visit:
    """A page with a city in it, and all that went wrong there."""

    def __init__(self, browser: Any, address: str) -> None:
        self.page = browser.new_page(viewport={"width": 640, "height": 480})
        self.troubles: list[str] = []
        self.requests: list[str] = []
        self.page.set_default_timeout(120_000)
        self.page.on("console", self._heard)
        self.page.on("pageerror", lambda error: self.troubles.append(str(error)))
        self.page.on("request", lambda one: self.requests.append(one.url))
        self.page.goto(address)

    def _heard(self, message: Any) -> None:
        # software GL finds reading pixels slow; the tiles library finds 1.1 new
        expected = ("GPU stall", "TilesRenderer: tiles versions", "GroupMarkerNotSet")
        loud = message.type in ("error", "warning")
        if loud and not any(words in message.text for words in expected):
            self.troubles.append(message.text)

    def ask(self, expression: str) -> Any:
        return self.page.evaluate(expression)

    def arrive(self) -> "Visit":
        """Wait until every block is there, then stop the clock."""
        self.ask("nostalgin.ready")
        self.ask("""new Promise(done => { const look = () => {
            const {loaded, blocks, progress} = nostalgin.stats;
            loaded >= blocks && progress >= 1 ? done() : setTimeout(look, 50);
        }; look(); })""")
        self.ask("nostalgin.hold()")
        return self

    def stand(self, x: float, z: float, yaw: float, pitch: float = 0.0) -> None:
        pose = {"x": x, "z": z, "yaw": yaw, "pitch": pitch}
        self.ask(f"nostalgin.setPose({json.dumps(pose)})")

    def press(self, key: str, seconds: float) -> dict[str, float]:
        """Hold a key for simulated seconds; tell where that leads."""
        self.page.keyboard.down(key)
        self.ask(f"""(async () => {{ for (let i = 0; i < {round(30 * seconds)}; i++)
            nostalgin.page.step(1 / 30); }})()""")
        self.page.keyboard.up(key)
        return self.ask("nostalgin.pose")


@pytest.fixture(scope="module")
def visit(browser: Any, address: str) -> Visit:
    return Visit(browser, address).arrive()
