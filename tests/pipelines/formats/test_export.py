"""What is exported equals what is shown, and programs we did not write read it."""

import contextlib
import json
import tracemalloc
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from PIL import Image
from typer.testing import CliRunner

from nostalgin_core.formats import Canvas
from pipelines.cli import app
from pipelines.formats import Unexportable, export, one_file
from pipelines.formats.published import Published
from pipelines.site import Foreign
from tests.core import sample_block
from tests.pipelines.formats import shown_city
from tests.pipelines.formats.readers import told
from tests.pipelines.formats.shown_city import BASE, lines, site_record


def tree(folder: Path) -> dict[str, bytes]:
    return {
        str(one.relative_to(folder)): one.read_bytes()
        for one in sorted(folder.rglob("*"))
        if one.is_file()
    }


IIIF = """
import json, sys
from iiif_prezi3 import Manifest
made = Manifest(**json.load(open(sys.argv[1], encoding="utf-8")))
again = json.loads(made.json())
print(json.dumps({"type": made.type, "items": len(made.items),
    "first": again["items"][0]["items"][0]["items"][0]["body"]}))
"""


def test_a_iiif_library_reads_the_manifest(globe: Path, out: Path) -> None:
    read = told("iiif_prezi3", IIIF, str(out / "iiif/manifest.json"))
    shown = {key for key, _ in sample_block.elevations("1")}
    assert (read["type"], read["items"]) == ("Manifest", len(shown))
    file = read["first"]["id"].removeprefix(f"{BASE}/")
    with Image.open(globe / "site" / file) as picture:
        assert picture.size == (read["first"]["width"], read["first"]["height"])


TILES = """
import json, sys
from pathlib import Path
from py3dtiles.tileset import TileSet
made = TileSet.from_file(Path(sys.argv[1]))
uris = []
def walk(tile):
    if tile.content_uri:
        uris.append(str(tile.content_uri))
    for child in tile.children:
        walk(child)
walk(made.root_tile)
print(json.dumps(uris))
"""


def test_py3dtiles_finds_every_block_in_the_tileset(globe: Path) -> None:
    uris = told("py3dtiles", TILES, str(globe / "site/tileset.json"))
    blocks = site_record(globe)["blocks"]
    wanted = {one[name] for one in blocks for name in ("uri", "coarse")}
    assert {uri.removeprefix("./") for uri in uris} == wanted


def test_the_same_city_gives_the_same_bytes(globe: Path, out: Path) -> None:
    again = globe.parent / "again"
    export(globe, again, ("cityjson", "obj", "geojson", "iiif"), base=BASE)
    assert tree(again) == tree(out)


def test_what_is_written_block_by_block_is_one_json_text(out: Path) -> None:
    for name, first in (("iiif/manifest.json", ""), ("geojson/footprints.geojson", 1)):
        data = (out / name).read_text()
        whole = json.loads(data)
        if first:
            each = (json.dumps(one, ensure_ascii=False) for one in whole["features"])
            told = ",\n".join(each)
            told = f'{{"type": "FeatureCollection", "features": [\n{told}\n]}}\n'
        else:
            told = json.dumps(whole, ensure_ascii=False)
        assert data == told


def test_an_export_that_fails_half_way_leaves_the_files_of_the_one_before(
    globe: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = ("geojson", "iiif")
    export(globe, tmp_path, wanted, base=BASE)
    before = tree(tmp_path)
    real, seen = Published.buildings, []

    def spoiled(self: Published, block: dict[str, Any]) -> list[dict[str, Any]]:
        seen.append(block)
        if len(seen) == 2:
            raise Unexportable("damaged")
        return real(self, block)

    monkeypatch.setattr(Published, "buildings", spoiled)
    for one in wanted:
        seen.clear()
        with pytest.raises(Unexportable, match="damaged"):
            export(globe, tmp_path, (one,), base=BASE)
        assert len(seen) == 2
        assert tree(tmp_path).keys() == before.keys()
        assert {n: d for n, d in tree(tmp_path).items() if ".nostalgin" not in n} == {
            n: d for n, d in before.items() if ".nostalgin" not in n
        }


class Long:
    """A city of 200 blocks, each told in 100,000 letters."""

    blocks = tuple({"name": str(n), "frame": None} for n in range(200))
    title = "A city"

    def ground(self, block: dict[str, Any]) -> None:
        """Tell nothing of where it lies."""


def of_geojson(folder: Path, city: Any) -> None:
    with contextlib.ExitStack() as ending:
        made = one_file.GeoJson(folder, city, ending)
        for block in city.blocks:
            shown: Any = SimpleNamespace(shells=[SimpleNamespace(**block)])
            made.add(block, shown, [])
        made.close()


def of_iiif(folder: Path, city: Any) -> None:
    one_file.Iiif(folder, city).write(f"{BASE}/")


@pytest.mark.parametrize("write", [of_geojson, of_iiif])
def test_no_more_than_a_block_is_held(
    write: Callable[[Path, Any], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def told(block: dict[str, Any]) -> str:
        return block["name"].ljust(100_000)

    def footprint(shell: Any, *_: Any, **__: Any) -> dict[str, str]:
        return {"told": told(vars(shell))}

    def pictures(_: Any, block: dict[str, Any]) -> list[Canvas]:
        more: Any = ("a.webp", "image/webp", 1, 1, "", "", "", {})
        return [Canvas(block["name"], told(block), *more)]

    monkeypatch.setattr(one_file, "attributes", lambda *_: {})
    monkeypatch.setattr(one_file.formats, "footprint", footprint)
    monkeypatch.setattr(one_file, "pictures", pictures)
    tracemalloc.start()
    try:
        write(tmp_path / "out", Long())
        held = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    (file,) = (one for one in (tmp_path / "out").iterdir() if one.name[0] != ".")
    assert file.stat().st_size > 200 * 100_000
    assert held < 20 * 100_000  # some copies of one block, of 200


def test_a_caption_of_ten_thousand_letters_survives(out: Path) -> None:
    made = json.loads((out / "iiif/manifest.json").read_text())
    assert made["items"][0]["label"]["none"] == [shown_city.LONG]
    assert len(shown_city.LONG) > 10_000


def test_a_city_without_a_place_has_no_geojson_but_all_else(tmp_path: Path) -> None:
    made = shown_city.published(tmp_path, shown_city.block_model("1", (0.0, 0.0)))
    with pytest.raises(Unexportable, match="no place on the globe"):
        export(made, tmp_path / "out", ("geojson",))
    assert not (tmp_path / "out").exists()
    alone = export(made, tmp_path / "alone", ("cityjson", "obj"))
    assert not alone.refused
    done = export(made, tmp_path / "out", ("cityjson", "obj", "geojson"))
    assert (done.files, list(done.refused)) == (alone.files, ["geojson"])
    assert tree(tmp_path / "out") == tree(tmp_path / "alone")
    assert "referenceSystem" not in lines(tmp_path / "out", "1")[0]["metadata"]


def test_the_command_names_what_it_can_t_write_and_ends_with_1(tmp_path: Path) -> None:
    made = shown_city.published(tmp_path, shown_city.block_model("1", (0.0, 0.0)))
    done = CliRunner().invoke(
        app, ["export", str(made), "--to", "geojson,cityjson,obj"]
    )
    assert done.exit_code == 1
    assert "exports/cityjson: 3 files" in done.stdout
    assert "exports/obj: 1 file" in done.stdout
    assert "geojson: GeoJSON knows degrees alone" in " ".join(done.stderr.split())
    assert "and build again" in " ".join(done.stderr.split())
    assert not (made / "exports/geojson").exists()


@pytest.mark.parametrize(
    ("wanted", "base", "why"),
    [
        (("gml",), "", "choose of"),
        ((), "", "choose of"),
        (("iiif",), "", "--base"),
        (("iiif",), "javascript:alert(1)", "--base"),
        (("prov",), "", "build it again"),
    ],
)
def test_what_can_t_be_told_is_refused_before_anything_is_written(
    globe: Path, tmp_path: Path, wanted: tuple[str, ...], base: str, why: str
) -> None:
    with pytest.raises(Unexportable, match=why):
        export(globe, tmp_path / "out", wanted, base=base)
    assert not (tmp_path / "out").exists()


def test_a_stranger_s_file_is_not_touched(globe: Path, tmp_path: Path) -> None:
    (tmp_path / "obj").mkdir()
    (tmp_path / "obj/1.zip").write_text("mine")
    with pytest.raises(Foreign):
        export(globe, tmp_path, ("obj",))
    assert tree(tmp_path) == {"obj/1.zip": b"mine"}


@pytest.mark.parametrize("name", ["../../etc/x", "a\nusemtl b", "שלום", "x" * 300])
def test_a_block_s_name_can_t_lead_out_of_the_folder(name: str, tmp_path: Path) -> None:
    fronts = tuple(
        replace(one, front_id=f"{name}-{one.lot}-{one.side}", block=name)
        for one in sample_block.fronts("1")
    )
    made = shown_city.published(tmp_path, shown_city.bare(name, fronts))
    before = set(tree(tmp_path))
    export(made, tmp_path / "out", ("cityjson", "obj"))
    fresh = set(tree(tmp_path)) - before
    assert all(one.startswith("out/") for one in fresh)
    (archive,) = (tmp_path / "out/obj").glob("*.zip")
    with zipfile.ZipFile(archive) as file:
        (obj,) = (one for one in file.namelist() if one.endswith(".obj"))
        commands = {line.split()[0] for line in file.read(obj).decode().splitlines()}
    assert commands == {"#", "mtllib", "usemtl", "o", "v", "vt", "f"}


@pytest.mark.parametrize("count", [1, 1000])
def test_a_block_of_one_lot_and_of_a_thousand_is_written(
    count: int, tmp_path: Path
) -> None:
    (first, *_) = sample_block.fronts("1")
    fronts = tuple(
        replace(
            first,
            front_id=f"7-{n}-{4 * n // count}",
            block="7",
            lot=str(n),
            side=4 * n // count,
            rank=n,
            street=f"Street {4 * n // count}",
            width_assumed=True,
            width_m=7.62,
        )
        for n in range(count)
    )
    made = shown_city.published(tmp_path, shown_city.bare("7", fronts))
    export(made, tmp_path / "out", ("cityjson", "obj"))
    rows = [one["CityObjects"].values() for one in lines(tmp_path / "out", "7")]
    kinds = [one["type"] for row in rows for one in row]
    assert kinds.count("Building") == count
    assert set(kinds) <= {"Building", "LandUse"}


def test_a_record_that_is_gone_or_damaged_is_named_with_the_remedy(
    tmp_path: Path,
) -> None:
    made = shown_city.published(tmp_path, shown_city.block_model("1", (0.0, 0.0)))
    (header,) = site_record(made)["blocks"]
    path = made / "site" / header["record"]
    path.write_bytes(path.read_bytes().replace(b"Street", b"Alley!", 1))
    words = f"{header['record']} is damaged; build the city again"
    with pytest.raises(Unexportable, match=words):
        export(made, tmp_path / "out", ("cityjson",))
    path.unlink()
    with pytest.raises(Unexportable, match=f"{header['record']}: No such file"):
        export(made, tmp_path / "out", ("iiif",), base=BASE)


def test_a_site_of_an_earlier_version_is_refused_with_the_remedy(
    tmp_path: Path,
) -> None:
    made = shown_city.published(tmp_path, shown_city.block_model("1", (0.0, 0.0)))
    told = site_record(made)
    for block in told["blocks"]:
        del block["record"]
    (made / "site/site.json").write_text(json.dumps(told))
    with pytest.raises(Unexportable, match=r"earlier version.*nostalgin build"):
        export(made, tmp_path / "out", ("obj",))
