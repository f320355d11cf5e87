"""A painted block that needs no network: fronts, elevations, and all that follows."""

import json
from functools import cache
from pathlib import Path

import numpy as np

from nostalgin_core import city, evidence
from nostalgin_core.block import Settled, raised
from nostalgin_core.model import atlas, facts, gltf, mesh, picture, yards
from nostalgin_core.records import (
    Assignment,
    Block,
    Elevation,
    Front,
    Mesh,
    Seen,
    Texture,
)

# lot, side, street, address, width, depth, storeys (0: no photograph)
LOTS = (
    ("1", 0, "West 1 Street", "115-119", 18.0, 15.0, 4),
    ("4", 0, "West 1 Street", "113", 7.5, 18.0, 5),
    ("5", 0, "West 1 Street", "109-111", 12.0, 20.0, 0),
    ("7", 0, "West 1 Street", "105-107", 15.0, 18.0, 6),
    ("9", 0, "West 1 Street", "101-103", 14.0, 16.0, 9),
    ("9", 1, "First Avenue", "1-3", 16.0, 14.0, 9),
    ("10", 1, "First Avenue", "5", 8.0, 18.0, 3),
    ("12", 1, "First Avenue", "7-9", 20.0, 18.0, 5),
    ("14", 2, "West 2 Street", "102-106", 22.0, 18.0, 7),
    ("16", 2, "West 2 Street", "108", 7.0, 18.0, 4),
    ("17", 2, "West 2 Street", "110-112", 16.0, 17.0, 12),
    ("20", 2, "West 2 Street", "114", 9.0, 18.0, 4),
    ("22", 3, "Second Avenue", "8-10", 17.0, 14.0, 5),
    ("24", 3, "Second Avenue", "4-6", 13.0, 18.0, 3),
    ("1", 3, "Second Avenue", "2", 15.0, 18.0, 4),
)
STOREY_M = 3.6
TEXELS = 16  # a metre


def fronts(name: str = "1") -> tuple[Front, ...]:
    return tuple(
        Front(
            front_id=f"{name}-{lot}-{side}",
            block=name,
            lot=lot,
            ring=0,
            side=side,
            rank=rank,
            street=street,
            address=address,
            width_m=width,
            depth_m=depth,
            width_assumed=False,
        )
        for rank, (lot, side, street, address, width, depth, _) in enumerate(LOTS)
    )


def painted(width_m: float, storeys: int, *, facade: int, seed: int) -> Elevation:
    """Paint windows on a wall; a car hid its foot, and some roofs are stepped."""
    rng = np.random.default_rng(seed)
    h, w = round(storeys * STOREY_M * TEXELS), round(width_m * TEXELS)
    wall = rng.normal(rng.integers(90, 190), 6, (h, w))
    bays = max(2, round(width_m / 2.6))
    for storey in range(storeys):
        for bay in range(bays):
            x = round((bay + 0.5) * w / bays)
            y = round((storey + 0.55) * h / storeys)
            wall[y - 15 : y + 15, x - 9 : x + 9] = 35
            wall[y - 1 : y + 1, x - 9 : x + 9] = 160
            wall[y + 15 : y + 18, x - 11 : x + 11] += 35
    wall[: TEXELS // 3] += 25
    codes = np.full((h, w), evidence.PHOTOGRAPHED, np.uint8)
    step = TEXELS if seed % 3 == 0 else 0
    codes[:step, : w // 4] = codes[:step, -w // 4 :] = evidence.NOTHING
    codes[-20:, w // 3 : w // 3 + 45] = evidence.INPAINTED
    codes[-22:-20, w // 3 : w // 3 + 45] = evidence.SOFT_EDGE
    if seed % 4 == 1:
        codes[:, -w // 6 :] = evidence.BEYOND_FRAME
    return plain(np.clip(wall, 0, 255).astype(np.uint8), codes, facade=facade)


def plain(
    image: np.ndarray,
    codes: np.ndarray | None = None,
    alpha: np.ndarray | None = None,
    *,
    facade: int = 0,
) -> Elevation:
    """Make an elevation of an image, all photographed unless told otherwise."""
    h, w = image.shape
    if codes is None:
        codes = np.full((h, w), evidence.PHOTOGRAPHED, np.uint8)
    if alpha is None:
        alpha = (codes == evidence.PHOTOGRAPHED).astype(np.float32)
    return Elevation(
        facade=facade,
        image=image,
        alpha=alpha,
        evidence=codes,
        quad=np.array([[0.0, 0.0], [w, 0.0], [w, h], [0.0, h]]),
        photo_from_elevation=np.eye(3),
        vanishing_points=np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
        focal_px=None,
        aspect=w / h,
        vanishing_sd_deg=(0.1, 0.1),
        focal_sd_px=None,
        aspect_sd=0.01 * w / h,
        method="painted",
    )


def tiles(name: str) -> dict[atlas.TileKey, Elevation]:
    """Key the painted elevations as an atlas does."""
    return {(*key, None): one for key, one in elevations(name).items()}


@cache
def elevations(name: str = "1") -> dict[Texture, Elevation]:
    drawn = {}
    for number, (lot, side, _, _, width, _, storeys) in enumerate(LOTS):
        if storeys:
            key = (
                f"photo-{name}-{lot}",
                1 if (lot, side) in {("9", 1), ("1", 0)} else 0,
            )
            seed = number + 100 * sum(map(ord, name))
            drawn[key] = painted(width, storeys, facade=key[1], seed=seed)
    return drawn


def assignments(name: str = "1") -> tuple[Assignment, ...]:
    return tuple(
        Assignment(
            front_id=f"{name}-{lot}-{side}",
            photo=f"photo-{name}-{lot}",
            facade=int((lot, side) in {("9", 1), ("1", 0)}),
            score=0.9,
        )
        for lot, side, *_, storeys in LOTS
        if storeys
    )


def seen(name: str = "1") -> list[Seen]:
    """See every painted elevation, the right one of a corner to the right."""
    return [
        Seen(
            photo=photo,
            facade=facade,
            target=True,
            target_score=0.9,
            score=0.95,
            aspect=one.aspect,
            aspect_sd=one.aspect_sd,
            left_px=100.0 + 200.0 * facade,
            area_px=50_000.0,
            photographed=0.9,
        )
        for (photo, facade), one in elevations(name).items()
    ]


@cache
def settled(name: str = "1") -> Settled:
    """Raise the block from the true assignments."""
    given = fronts(name), assignments(name)
    return Settled(*given, (), raised(name, *given, seen(name)))


@cache
def sheet(name: str) -> atlas.Atlas:
    """Draw the atlas of the block's walls."""
    made, _ = built(name)
    drawn = elevations(name)
    return atlas.build(
        {key: drawn[key[:2]] for key in atlas.wanted(made)}, longest_px=512
    )


def any_mesh() -> Mesh:
    """Make some building's mesh."""
    made, _ = built("1")
    return mesh.building(made.buildings[0], sheet("1"))


@cache
def built(name: str = "1") -> tuple[Block, bytes]:
    """Build the block and write it, once."""
    return rebuilt(name)


def rebuilt(name: str) -> tuple[Block, bytes]:
    """Build the block and write it."""
    drawn, made = elevations(name), settled(name).block
    page = atlas.build(
        {key: drawn[key[:2]] for key in atlas.wanted(made)}, longest_px=512
    )
    meshes = [
        (one.building_id, mesh.building(one, page, number=number))
        for number, one in enumerate(made.buildings)
    ]
    data = gltf.glb(
        name,
        meshes,
        colours=picture.colours(page),
        evidence=picture.evidence_key(page),
        table=known(name),
        ground=yards.yards(made, page),
        copyright="painted",
        extras={"evidence": picture.legend(), "block": name},
    )
    return made, data


def known(name: str) -> dict[str, list[str] | np.ndarray]:
    """Tell what is known of each building, in words, numbers and flags."""
    made = settled(name).block
    flags = np.array([one.assumed for one in made.buildings], np.uint8)
    storeys = np.array([round(b.height_m / STOREY_M) for b in made.buildings], np.int32)
    numbers = {"flag": flags, "storeys": storeys, **facts.measures(made)}
    return {**facts.table(settled(name)), **numbers}


def bounds(
    made: Block,
) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Find the lowest and highest corner of a block: east, north, up, in metres."""
    ground = np.concatenate([one.footprint_m for one in made.buildings])
    top = max(one.height_m for one in made.buildings)
    (east0, north0), (east1, north1) = ground.min(axis=0), ground.max(axis=0)
    low = (float(east0), float(north0), 0.0)
    return low, (float(east1), float(north1), float(top))


def write_site(folder: Path, names: tuple[str, ...] = ("1", "2")) -> None:
    """Write blocks, tileset and buildings for trying a viewer."""
    (folder / "blocks").mkdir(parents=True, exist_ok=True)
    tiles, rows = [], []
    for index, name in enumerate(names):
        made, data = built(name)
        (folder / "blocks" / f"{name}.glb").write_bytes(data)
        low, high = bounds(made)
        origin = (0.0, index * 90.0)
        tiles.append(city.Tile(f"blocks/{name}.glb", low, high, origin_m=origin))
        table = known(name)
        columns = [
            value if isinstance(value, list) else value.tolist()
            for value in table.values()
        ]
        rows += [
            dict(zip(table, row, strict=True)) for row in zip(*columns, strict=True)
        ]
    text = json.dumps(city.tree(tiles).tileset, indent=1)
    (folder / "tileset.json").write_text(text)
    (folder / "buildings.json").write_text(json.dumps(rows, indent=1))


if __name__ == "__main__":
    import sys

    write_site(Path(sys.argv[1]))
