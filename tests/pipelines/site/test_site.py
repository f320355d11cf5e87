import io
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from nostalgin_core import rests
from nostalgin_core.model import atlas, picture
from nostalgin_core.records import (
    Assignment,
    Block,
    Building,
    Front,
    Height,
    Standpoint,
    Wall,
)
from pipelines.index.row import Row
from pipelines.site import camera, site
from pipelines.site.folder import RECORD, Folder, Foreign
from pipelines.site.record import record as recorded
from pipelines.site.said import words_of, years
from pipelines.store import tables
from tests.core import listed

WEBP = site.thumbnail(np.zeros((40, 30), np.uint8))


@pytest.fixture
def viewer(tmp_path: Path) -> Path:
    folder = tmp_path / "viewer"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text("<!doctype html>")
    (folder / "assets" / "index-1.js").write_text("1")
    return folder


def model(name: str = "993", glb: bytes = b"glTF", **more: Any) -> site.BlockModel:
    photos = [{"key": "ab"}, {"key": "gone"}]
    record = {"block": name, "buildings": [{"id": f"{name}-1", "photos": photos}]}
    low, high = (0.0, 0.0, 0.0), (10.0, 20.0, 30.0)
    return site.BlockModel(name, glb, record, low, high, **more)


def assembled(
    folder: Path,
    viewer: Path,
    *blocks: site.BlockModel,
    photos: dict[str, bytes] | None = None,
    title: str = "A city",
) -> dict[str, Any]:
    photos = {"ab": WEBP} if photos is None else photos
    site.assemble(folder, blocks=blocks, photos=photos, title=title, viewer=viewer)
    return json.loads((folder / "site.json").read_text())


def files(folder: Path) -> dict[str, bytes]:
    found = folder.rglob("*")
    return {
        str(one.relative_to(folder)): one.read_bytes() for one in found if one.is_file()
    }


def test_every_file_that_is_named_is_there(tmp_path: Path, viewer: Path) -> None:
    record = assembled(tmp_path / "site", viewer, model())
    (block,) = record["blocks"]
    tileset = json.loads((tmp_path / "site/tileset.json").read_text())
    (leaf,) = tileset["root"]["children"]
    assert leaf["content"]["uri"] == block["uri"]
    assert (tmp_path / "site" / block["uri"]).read_bytes() == b"glTF"
    known = json.loads((tmp_path / "site" / block["record"]).read_text())
    first, second = known["buildings"][0]["photos"]
    assert (tmp_path / "site" / first["file"]).read_bytes() == WEBP
    assert second["file"] is None


def test_the_same_city_gives_the_same_bytes(tmp_path: Path, viewer: Path) -> None:
    for name in ("one", "two"):
        assembled(tmp_path / name, viewer, model(), model("994"))
    assert files(tmp_path / "one") == files(tmp_path / "two")


def test_the_tileset_is_swapped_in_last(
    tmp_path: Path, viewer: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    order = []
    write = Folder.write
    monkeypatch.setattr(
        Folder,
        "write",
        lambda self, name, data: order.append(name) or write(self, name, data),
    )
    assembled(tmp_path / "site", viewer, model())
    assert order[-1] == "tileset.json"


def test_the_site_tells_the_colours_that_its_models_evidence_is_painted_in(
    tmp_path: Path, viewer: Path
) -> None:
    legend = assembled(tmp_path / "site", viewer, model())["legend"]
    codes = np.array(sorted(rests.NAMES), np.uint8)[None]
    page = atlas.Atlas(codes, codes, codes, {}, ())
    painted = Image.open(io.BytesIO(picture.evidence_key(page).data)).convert("RGB")
    tints = [legend[str(code)]["tint"] for code in codes[0]]
    assert np.asarray(painted)[0].tolist() == tints
    assert len({tuple(tint) for tint in tints}) == len(legend) == codes.size


def test_a_new_model_takes_the_place_of_the_old(tmp_path: Path, viewer: Path) -> None:
    folder = tmp_path / "site"
    old = assembled(folder, viewer, model())["blocks"][0]["uri"]
    new = assembled(folder, viewer, model(glb=b"glTF2"), photos={})["blocks"][0]["uri"]
    assert old != new
    assert (folder / old).exists()  # whoever reads the old city reads it to its end
    assembled(folder, viewer, model(glb=b"glTF2"), photos={})
    assert not (folder / old).exists()
    assert list((folder / "photos").glob("*")) == []


def test_hostile_names_stay_inside(tmp_path: Path, viewer: Path) -> None:
    before = set(files(tmp_path))
    names = ["../../up", "/etc/x", "a\0b", "", "..", "C:\\x", "a/b"]
    assembled(
        tmp_path / "site",
        viewer,
        *map(model, names),
        photos={f"{n}/..": WEBP for n in names},
    )
    new = set(files(tmp_path)) - before
    assert all(name.startswith("site/") for name in new)
    assert sum(name.startswith("site/blocks/") for name in new) == len(names)


def test_names_that_look_alike_do_not_clash() -> None:
    names = ["a/b", "a-b", "a b", "a\\b", "A-B"]
    assert len({site.safe(name) for name in names}) == len(names)
    assert site.safe("993") == "993"


@pytest.mark.parametrize(
    "name",
    ["\u56db\u6761\u901a", "\u05e8\u05d7\u05d5\u05d1", "& <", "_x", "-y", ".git"],
)
def test_no_file_of_a_site_is_hidden(name: str) -> None:
    assert site.safe(name)[0].isalnum()
    assert site.safe(name) != site.safe(name + "!")


def test_a_link_that_leads_out_is_refused(tmp_path: Path, viewer: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "site").mkdir()
    (tmp_path / "site/blocks").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "site" / RECORD).write_text('{"now": [], "before": []}')
    with pytest.raises(Foreign, match="leads out"):
        assembled(tmp_path / "site", viewer, model())
    assert list((tmp_path / "elsewhere").iterdir()) == []


def test_a_missing_viewer_names_the_command(tmp_path: Path) -> None:
    with pytest.raises(site.ViewerMissingError, match="make viewer"):
        assembled(tmp_path / "site", tmp_path, model())


def test_two_blocks_of_one_name_are_a_mistake(tmp_path: Path, viewer: Path) -> None:
    with pytest.raises(ValueError, match="993"):
        assembled(tmp_path / "site", viewer, model(), model())


def test_thumbnails_never_grow() -> None:
    small = site.thumbnail(np.zeros((40, 30), np.uint8))
    large = site.thumbnail(np.zeros((4000, 3000), np.uint8), longest_px=100)
    assert site.suffix(small) == site.suffix(large) == ".webp"
    assert len(large) < 1000


def front(side: int, *, rank: int, width_m: float) -> Front:
    block, street = "993", f"Street {side}"
    return listed.front("11", side, rank, block=block, street=street, width_m=width_m)


def corner() -> Block:
    """A building of 10 by 30 metres; a photograph shows its first front only."""
    square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 30.0], [0.0, 30.0]])
    ends = [tuple(map(float, point)) for point in square]
    wears = [("ab", 0), None, None, None]
    walls = tuple(
        Wall(
            ends[i],
            ends[(i + 1) % 4],
            f"993-11-{i}" if i < 2 else None,
            wears[i],
            None if i == 0 else 6,
        )
        for i in range(4)
    )
    height = Height(20.0, 17.0, 24.5, 18.0, None, supported=True)
    built = Building("993-11", square, 20.0, walls, assumed=False, height=height)
    return Block("993", (built,), (square,))


STOOD = Standpoint(  # before the middle of a front 10 m wide, 20 m off, eyes at 1.5 m
    size_px=(600, 800),
    photo_from_camera=np.array([[700.0, 0, 299.5], [0, 700.0, 399.5], [0, 0, 1]]),
    focal_sd=0.1,
    position=(0.5, 0.15, 2.0),
    position_sd=0.2,
    front_from_camera=np.array([[1.0, 0, 0], [0, -1, 0], [0, 0, -1]]),
    quad_px=np.array([[124.5, 20], [474.5, 20], [474.5, 452], [124.5, 452]]),
    roof=2.1,
)


def test_a_photo_that_shows_a_front_is_placed_before_it() -> None:
    one = told(stood={("ab", 0): STOOD})["photos"][0]["camera"]
    assert one["front"] == "993-11-0"
    assert one["position_m"] == [5.0, -20.0, 1.5]  # its street lies to the south
    assert (one["position_sd_m"], one["roof_m"]) == (2.0, 21.0)
    assert one["block_from_camera"] == [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    assert (one["focal_px"], one["focal_sd_px"]) == (700.0, 70.0)
    assert "camera" not in told()["photos"][0]


def test_the_front_of_the_model_seen_by_the_camera_is_the_quad() -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        start, end = rng.uniform(-50, 50, (2, 2))
        wall = Wall((start[0], start[1]), (end[0], end[1]), "f", ("ab", 0), None)
        turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        one = camera.camera(replace(STOOD, front_from_camera=turn), wall)
        width = float(np.hypot(*(end - start)))
        for x, y in ((0, 0), (1, 0), (1, STOOD.roof), (0, STOOD.roof)):
            here = [*(start + x * (end - start)), y * width]
            seen = np.subtract(here, one["position_m"]) @ one["block_from_camera"]
            true = (np.array([x, y, 0.0]) - STOOD.position) @ turn
            np.testing.assert_allclose(seen / width, true, atol=0.01 / width + 2e-5)


def test_a_footprint_starts_at_the_front() -> None:
    assert told()["footprint_m"] == [[0, 0], [10, 0], [10, 30], [0, 30]]


def test_a_row_says_date_and_record_of_its_photo_and_when_the_house_was_built() -> None:
    words = {"date": "1940", "source_url": "https://archive.example/7", "year": "1911"}
    row = Row(2, "root", "a.jpg", front(0, rank=0, width_m=9.0), "Archive", words)
    photo = {"credit": "Archive", "date": "1940", "source_url": words["source_url"]}
    (plain,) = told_rows([row])
    assert words_of([plain | {"key": "ab"}, plain]) == {"ab": photo}
    assert years([plain]) == {"993-11": {"year": "1911"}}


def told_rows(rows: list[Row]) -> list[dict[str, Any]]:
    """Give rows as `joined` hands them on, none of whose photos could be read."""
    return [
        {
            "key": None,
            "photo": row.photo,
            "credit": row.credit,
            "said": row.told,
            "year": row.cells.get("year", ""),
            "front": tables.to_row(row.front),
            "rejections": [],
        }
        for row in rows
    ]


def test_only_a_web_page_is_handed_on_as_a_record() -> None:
    for address in ("javascript:alert(1)", "data:text/html,x", "/etc/passwd", ""):
        row = Row(2, "root", "a.jpg", None, "Archive", {"source_url": address})
        assert row.told == {}


def told(**more: Any) -> dict[str, Any]:
    seen = listed.seen("ab", aspect=0.5, aspect_sd=0.01, photographed=0.8)
    known = recorded(
        corner(),
        fronts=[front(1, rank=1, width_m=30.0), front(0, rank=0, width_m=10.0)],
        assignments=[
            Assignment("993-11-0", "ab", 0, 0.9),
            Assignment("993-11-0", "cd", 1, 0.5),
        ],
        seen=[seen],
        photos={"ab": {"credit": "Archive"}},
        **more,
    )
    return known["buildings"][0]


def test_a_front_that_no_photograph_shows_counts_as_unseen() -> None:
    assert told()["photographed_share"] == pytest.approx(0.8 * 10 / 40)


def test_a_height_is_told_with_its_witnesses() -> None:
    one = told()
    assert (one["height_low_m"], one["height_high_m"]) == (17.0, 24.5)
    assert (one["height_by_storeys_m"], "height_by_width_m" in one) == (18.0, False)
    assert one["height_assumed"] is False


def test_the_photograph_that_is_worn_comes_first() -> None:
    first, second = told()["photos"]
    assert first == {"key": "ab", "used": True, "credit": "Archive"}
    assert second == {"key": "cd", "used": False}


def test_addresses_run_in_the_order_of_the_ring() -> None:
    assert told()["address"] == "1 Street 0; 1 Street 1"
    assert told()["width_m"] == 10.0
    assert told(more={"993-11": {"year": "1940"}})["year"] == "1940"
