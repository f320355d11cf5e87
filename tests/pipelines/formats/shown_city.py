"""A painted city of two blocks that is published, on a plane or on the globe."""

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from nostalgin_core import city, model
from nostalgin_core.block import Settled, raised
from nostalgin_core.model import Rights
from nostalgin_core.records import Front
from pipelines.site import site
from pipelines.site.record import record
from tests.core import sample_block

Json = dict[str, Any]

BASE = "https://archive.example/city"
MIDTOWN = city.Place(-73.9868, 40.7549, 12.0)
ARCHIVE = Rights("An Archive", "CC0", ("https://archive.example/1",))
LONG = "שָׁלוֹם רחוב " * 800  # ten thousand letters from right to left


def block_model(name: str, origin_m: tuple[float, float]) -> site.BlockModel:
    """Model a painted block."""
    settled = sample_block.settled(name)
    made = model.model(settled, sample_block.elevations(name), rights=ARCHIVE)
    photos = {
        one.photo: {"credit": "An Archive", "caption": LONG}
        for one in settled.assignments
    }
    return written(settled, made, name, origin_m, photos)


def written(
    settled: Settled, made: Any, name: str, origin_m: Any, photos: Any
) -> site.BlockModel:
    known = record(
        settled.block,
        fronts=settled.fronts,
        assignments=settled.assignments,
        seen=(),
        photos=photos,
    )
    low, high = made.mesh.positions_m.min(axis=0), made.mesh.positions_m.max(axis=0)
    return site.BlockModel(
        name,
        made.glb,
        known,
        tuple(low.tolist()),
        tuple(high.tolist()),
        origin_m,
        turn_rad=0.3,
        coarse=made.coarse or None,
        coarse_texel_m=made.coarse_texel_m,
        footprints_m=np.array([one.footprint_m for one in settled.block.buildings]),
        heights_m=np.array([one.height_m for one in settled.block.buildings]),
    )


def bare(name: str, fronts: tuple[Front, ...]) -> site.BlockModel:
    """Model a block that no photograph shows."""
    settled = Settled(fronts, (), (), raised(name, fronts, (), []))
    return written(settled, model.model(settled, {}), name, (0.0, 0.0), {})


def published(
    folder: Path, *blocks: site.BlockModel, place: city.Place | None = None
) -> Path:
    """Publish blocks with a viewer that is none, and give the city's folder."""
    viewer = folder / "viewer"
    (viewer / "assets").mkdir(parents=True, exist_ok=True)
    (viewer / "index.html").write_text("<!doctype html>")
    (folder / "city").mkdir(exist_ok=True)
    pictures = {
        key: site.thumbnail(one.image)
        for (key, _), one in sample_block.elevations("1").items()
    }
    site.assemble(
        folder / "city/site",
        blocks=blocks,
        photos=pictures,
        title=LONG,
        place=place,
        viewer=viewer,
    )
    return folder / "city"


def lines(out: Path, block: str) -> list[Json]:
    path = out / "cityjson" / f"{block}.city.jsonl"
    return [json.loads(line) for line in path.read_text().splitlines()]


def site_record(city: Path) -> Json:
    return json.loads((city / "site/site.json").read_text())


def glb(city: Path, block: str) -> trimesh.Scene:
    (one,) = (o for o in site_record(city)["blocks"] if o["name"] == block)
    data = (city / "site" / one["uri"]).read_bytes()
    return trimesh.load(io.BytesIO(data), file_type="glb")
