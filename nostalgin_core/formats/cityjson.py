"""CityJSON 2.0 as a sequence: a first line for the city, then a line a building.

Every building has two geometries: LoD 1.2, a closed solid on its footprint up to its
height, for those who measure; and LoD 2.0, the surfaces as they are shown, with the
photograph and the evidence as two themes of textures. That one is no solid: a front
rises above the roof behind it. The yards of a block are a line of their own, a LandUse.

CityJSON's texture coordinates begin at the lower left. Lengths are whole millimetres.
"""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np
from jaxtyping import Float

from nostalgin_core.formats.located import Ground
from nostalgin_core.formats.shown import Shell, Surface

Json = dict[str, Any]

MILLIMETRE: Final = 0.001
CRS: Final = "https://www.opengis.net/def/crs/EPSG/0/{}"
THEMES: Final = ("photograph", "evidence")
SEMANTICS: Final = [
    {"type": "GroundSurface"},
    {"type": "RoofSurface"},
    {"type": "WallSurface"},
]
KINDS: Final = [one["type"] for one in SEMANTICS]


def header(ground: Ground, *, title: str) -> Json:
    """Write the first line; without a place on the globe it names no CRS."""
    metadata: Json = {"title": title}
    if ground.epsg is not None:
        metadata["referenceSystem"] = CRS.format(ground.epsg)
    return {
        "type": "CityJSON",
        "version": "2.0",
        "transform": _transform(ground),
        "metadata": metadata,
        "CityObjects": {},
        "vertices": [],
    }


def feature(
    shell: Shell,
    ground: Ground,
    *,
    attributes: Mapping[str, Any],
    images: Sequence[str],
) -> Json:
    """Write one building's line. `images` are the files of both themes, in order."""
    vertices = _Vertices(ground)
    geometries = [_shown(shell, vertices)]
    if shell.footprint_m is not None:
        geometries.insert(0, _solid(shell, vertices))
    building = {
        "type": "Building",
        "attributes": dict(attributes),
        "geometry": geometries,
    }
    return _line(shell, building, vertices, images)


def land(shell: Shell, ground: Ground, *, images: Sequence[str]) -> Json:
    """Write the line of a block's yards, which nobody photographed."""
    vertices = _Vertices(ground)
    surface = _shown(shell, vertices)
    del surface["semantics"]  # CityJSON knows none of land
    use = {
        "type": "LandUse",
        "attributes": {"function": "yard", "evidence_assumed": 1.0},
        "geometry": [surface],
    }
    return _line(shell, use, vertices, images)


def _line(
    shell: Shell, told: Json, vertices: "_Vertices", images: Sequence[str]
) -> Json:
    coordinates = [
        [round(float(u), 7), round(1.0 - float(v), 7)]
        for one in shell.surfaces
        for u, v in one.uvs
    ]
    return {
        "type": "CityJSONFeature",
        "id": shell.name,
        "CityObjects": {shell.name: told},
        "vertices": vertices.written,
        "appearance": {
            "textures": [
                {
                    "type": "PNG",
                    "image": image,
                    "wrapMode": "clamp",
                    "textureType": "specific",
                }
                for image in images
            ],
            "vertices-texture": coordinates,
        },
    }


class _Vertices:
    """Whole millimetres from the city's origin, each written once."""

    def __init__(self, ground: Ground) -> None:
        self._ground = ground
        self._known: dict[tuple[int, ...], int] = {}

    @property
    def written(self) -> list[list[int]]:
        return [list(one) for one in self._known]

    def __call__(self, corners_m: Float[np.ndarray, "n 3"]) -> list[int]:
        away = self._ground.metres(corners_m) - self._ground.origin_m
        rows = np.round(away / MILLIMETRE).astype(int).tolist()
        return [self._known.setdefault(tuple(row), len(self._known)) for row in rows]


def _transform(ground: Ground) -> Json:
    return {"scale": [MILLIMETRE] * 3, "translate": list(ground.origin_m)}


def _shown(shell: Shell, vertices: _Vertices) -> Json:
    starts = np.cumsum([0] + [len(one.uvs) for one in shell.surfaces[:-1]]).tolist()
    rings = [
        list(range(start, start + len(one.uvs)))
        for start, one in zip(starts, shell.surfaces, strict=True)
    ]
    return {
        "type": "MultiSurface",
        "lod": "2.0",
        "boundaries": [[vertices(one.corners_m)] for one in shell.surfaces],
        "semantics": {"surfaces": SEMANTICS, "values": _kinds(shell.surfaces)},
        "texture": {
            theme: {"values": [[[number, *ring]] for ring in rings]}
            for number, theme in enumerate(THEMES)
        },
    }


def _solid(shell: Shell, vertices: _Vertices) -> Json:
    flat = shell.footprint_m
    assert flat is not None
    low = vertices(np.column_stack([flat, np.zeros(len(flat))]))
    high = vertices(np.column_stack([flat, np.full(len(flat), shell.height_m)]))
    count = len(low)
    walls = [
        [[low[k], low[(k + 1) % count], high[(k + 1) % count], high[k]]]
        for k in range(count)
    ]
    return {
        "type": "Solid",
        "lod": "1.2",
        "boundaries": [[[low[::-1]], [high], *walls]],
        "semantics": {"surfaces": SEMANTICS, "values": [[0, 1, *([2] * count)]]},
    }


def _kinds(surfaces: Sequence[Surface]) -> list[int]:
    return [KINDS.index(one.kind) for one in surfaces]
