"""What a city of many blocks costs: its tileset, and its whole painted site.

Baseline: a flat list of all blocks in one file, as 3D Tiles allows and as was written
before. The painted city wears a few painted blocks over and over, so that models are
real ones and the measure is of the site, not of the painting.

    python tests/bench/bench_tileset.py [BUILDINGS]
"""

import json
import resource
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

from nostalgin_core.city.tileset import Tile, city_from_block, leaf
from nostalgin_core.city.tree import tree
from pipelines.site import site
from tests.core.city.test_tree import blocks
from tests.pipelines.formats.shown_city import block_model

COUNTS = (100, 1000, 10_000)
NAME = "77777"  # of the painted block, in which no picture's bytes are likely to be


def flat_bytes(tiles: list[Tile]) -> int:
    """Measure the baseline: every block's tile in one file."""
    children = [leaf(one, city_from_block(one, None)) for one in tiles]
    return len(json.dumps(children, separators=(",", ":")))


def tilesets() -> None:
    """Print what the first file and all files take, beside the flat list."""
    print("blocks  first file  all files  volumes  flat list  first/flat  CPU s")
    for count in COUNTS:
        tiles = blocks(count)
        began = time.process_time()
        made = tree(tiles)
        seconds = time.process_time() - began
        first = len(json.dumps(made.tileset, separators=(",", ":")))
        texts = [f() for name, f in made.files.items() if name.endswith(".json")]
        volumes = [f() for name, f in made.files.items() if name.endswith(".glb")]
        flat = flat_bytes(tiles)
        print(
            f"{count:6} {first:12,} {first + sum(map(len, texts)):13,} "
            f"{sum(map(len, volumes)):9,} {flat:9,} {first / flat:9.3f} {seconds:4.1f}"
        )


def peak_mib() -> float:
    """Tell the most memory that this process has had."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def painted(buildings: int) -> None:
    """Assemble a painted city, and print time and memory beside a tenth of it."""
    before = None
    print("buildings  blocks  seconds  ms/block  site MiB  peak MiB")
    for count in (buildings // 10, buildings):
        city = painted_city(count)
        number, each = len(city), len(city[0].record["buildings"])
        with tempfile.TemporaryDirectory() as folder:
            began = time.perf_counter()
            site.assemble(Path(folder) / "site", blocks=city, photos={}, title="")
            seconds = time.perf_counter() - began
            files = [p for p in Path(folder).rglob("*") if p.is_file()]
            size = sum(p.stat().st_size for p in files)
            first = (Path(folder) / "site/tileset.json").stat().st_size
        per_block = 1000 * seconds / number
        print(
            f"{number * each:9} {number:7} {seconds:8.1f} {per_block:9.1f} "
            f"{size / 2**20:9.0f} {peak_mib():9.0f}   tileset.json {first:,} bytes"
        )
        if before is not None:
            print(f"ten times the city: {per_block / before:.2f} x the time a block")
        before = per_block


def painted_city(buildings: int) -> list[site.BlockModel]:
    """Model as many painted blocks as hold so many buildings, side by side."""
    one = block_model(NAME, (0.0, 0.0))
    number = -(-buildings // len(one.record["buildings"]))
    across = max(1, round(number**0.5))
    return [
        renamed(one, n, (130.0 * (n % across), 110.0 * (n // across)))
        for n in range(number)
    ]


def renamed(
    one: site.BlockModel, number: int, origin_m: tuple[float, float]
) -> site.BlockModel:
    """Give a block and its buildings names of their own, in record and models."""
    name = f"{number:0{len(NAME)}}"
    old, new = (f"{block}-".encode() for block in (NAME, name))  # of one length
    record = json.loads(json.dumps(one.record).replace(f'"{NAME}-', f'"{name}-'))
    for photo in (p for one in record["buildings"] for p in one["photos"]):
        photo["caption"] = f"Plate {photo['key']}"  # the tests' are monsters
    return replace(
        one,
        name=name,
        glb=one.glb.replace(old, new),
        coarse=one.coarse and one.coarse.replace(old, new),
        record={**record, "block": name},
        origin_m=origin_m,
    )


if __name__ == "__main__":
    tilesets()
    painted(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)
