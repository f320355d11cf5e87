"""What a published GLB of ours shows: its surfaces, its images, its words.

Whatever is exported is read from here, so that it equals what is shown.
"""

import io
import json
import struct
from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image

from nostalgin_core import evidence, rests
from nostalgin_core.arrays import EvidenceMap

Json = dict[str, Any]
Kind = Literal["WallSurface", "RoofSurface", "GroundSurface"]

TYPES: Final = {5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}
WORDS: Final = {
    evidence.PHOTOGRAPHED: "photographed",
    evidence.SOFT_EDGE: "soft_edge",
    evidence.INPAINTED: "inpainted",
    evidence.BEYOND_FRAME: "beyond_frame",
    evidence.COPIED: "copied",
    evidence.ASSUMED: "assumed",
    rests.ANOTHER: "another_picture",
}
FLAT: Final = 0.5  # of a normal's height, from which a surface is no wall
SQUARE_MM: Final = 1e-6  # m2; less is no surface


class Unreadable(ValueError):  # noqa: N818 - it reads as what it is about
    """Bytes that are no GLB of ours."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """One flat polygon, anticlockwise seen from outside."""

    kind: Kind
    corners_m: Float[np.ndarray, "n 3"]  # east, north, up in the block's frame
    uvs: Float[np.ndarray, "n 2"]  # (0, 0) is the top left of the images

    @property
    def area_m2(self) -> float:
        """Measure it."""
        away = self.corners_m[1:] - self.corners_m[0]
        fan = np.cross(away[:-1], away[1:])
        return float(np.linalg.norm(fan.sum(axis=0)) / 2)


@dataclass(frozen=True, slots=True, eq=False)
class Shell:
    """One building's surfaces."""

    name: str
    surfaces: tuple[Surface, ...]

    @property
    def height_m(self) -> float:
        """Measure up to its highest corner."""
        return float(max(one.corners_m[:, 2].max() for one in self.surfaces))

    @property
    def footprint_m(self) -> Float[np.ndarray, "n 2"] | None:
        """Give its largest ground, anticlockwise seen from above; None: it has none."""
        grounds = [one for one in self.surfaces if one.kind == "GroundSurface"]
        if not grounds:
            return None
        return max(grounds, key=lambda one: one.area_m2).corners_m[::-1, :2]


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """One block as its GLB shows it."""

    block: str
    copyright: str
    extras: Json
    shells: tuple[Shell, ...]
    ground: Shell | None  # the yards, of no building; None: there are none
    colours: UInt8[np.ndarray, "h w 4"]
    evidence: EvidenceMap

    def shares(self, shell: Shell) -> dict[str, float]:
        """Tell which share of a building's walls rests on what, by area.

        Texels that show no wall count for nothing; the shares of the others add up to
        one.
        """
        counts = np.zeros(max(rests.NAMES) + 1)
        for one in shell.surfaces:
            if one.kind == "WallSurface":
                texels = self._texels(one)
                found = np.bincount(texels.ravel(), minlength=len(counts))
                counts += found[: len(counts)] * (one.area_m2 / texels.size)
        counts[evidence.NOTHING] = 0.0
        whole = counts.sum() or 1.0
        return {word: float(counts[code] / whole) for code, word in WORDS.items()}

    def _texels(self, one: Surface) -> EvidenceMap:
        h, w = self.evidence.shape
        low, high = one.uvs.min(axis=0) * [w, h], one.uvs.max(axis=0) * [w, h]
        (x0, y0), (x1, y1) = np.round(low).astype(int), np.round(high).astype(int)
        return self.evidence[y0 : max(y1, y0 + 1), x0 : max(x1, x0 + 1)]


def read(data: bytes) -> Shown:
    """Read a block's GLB.

    Raises:
        Unreadable: if it is none, or none of ours.
    """
    try:
        return _read(data)
    except (struct.error, ValueError, LookupError, TypeError, OSError) as problem:
        raise Unreadable(f"it is no GLB of a block: {problem}") from problem


def png(image: UInt8[np.ndarray, "..."]) -> bytes:
    """Encode an image without loss; every program reads it."""
    file = io.BytesIO()
    Image.fromarray(image).save(file, "PNG", compress_level=6)
    return file.getvalue()


def tinted(codes: EvidenceMap) -> UInt8[np.ndarray, "h w 3"]:
    """Colour an evidence map with the tints that the legend names."""
    tints = [tint for _, tint in sorted(rests.TINTS.items())]
    return np.array(tints, np.uint8)[codes]


def _read(data: bytes) -> Shown:
    magic, version, length = struct.unpack_from("<4sII", data)
    if (magic, version) != (b"glTF", 2) or length != len(data):
        raise ValueError("wrong header or length")
    (size,) = struct.unpack_from("<I", data, 12)
    document, binary = json.loads(data[20 : 20 + size]), data[28 + size :]
    asset = document["asset"]
    shells, grounds = [], []
    for one in document["meshes"]:
        (part,) = one["primitives"]
        shell = Shell(one["name"], tuple(_surfaces(document, binary, part)))
        numbered = "_FEATURE_ID_0" in part["attributes"]
        (shells if numbered else grounds).append(shell)
    colours, codes = (
        Image.open(io.BytesIO(_view(document, binary, one["bufferView"])))
        for one in document["images"]
    )
    return Shown(
        block=str(document["scenes"][0]["name"]),
        copyright=str(asset.get("copyright", "")),
        extras=asset["extras"],
        shells=tuple(shells),
        ground=grounds[0] if grounds else None,
        colours=np.asarray(colours.convert("RGBA")),
        evidence=np.asarray(codes),
    )


def _surfaces(document: Json, binary: bytes, primitive: Json) -> list[Surface]:
    """Join two triangles that follow each other round a common diagonal."""
    given = primitive["attributes"]
    east, up, south = _array(document, binary, given["POSITION"]).astype(float).T
    points = np.column_stack([east, -south, up])
    uvs = _array(document, binary, given["TEXCOORD_0"]).astype(float)
    triangles = _array(document, binary, primitive["indices"]).reshape(-1, 3).tolist()
    faces: list[list[int]] = []
    for a, b, c in triangles:
        last = faces[-1] if faces else []
        if len(last) == 3 and (a, b) == (last[0], last[2]):
            last.append(c)
        else:
            faces.append([a, b, c])
    made = [Surface(_kind(points[face]), points[face], uvs[face]) for face in faces]
    return [one for one in made if one.area_m2 > SQUARE_MM]


def _kind(corners: Float[np.ndarray, "n 3"]) -> Kind:
    across = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    rise = across[2] / max(float(np.linalg.norm(across)), 1e-12)
    if abs(rise) <= FLAT:
        return "WallSurface"
    return "RoofSurface" if rise > 0 else "GroundSurface"


def _array(document: Json, binary: bytes, index: int) -> np.ndarray:
    one = document["accessors"][index]
    data = _view(document, binary, one["bufferView"])
    array = np.frombuffer(data, TYPES[one["componentType"]])
    width = WIDTHS[one["type"]]
    return array.reshape(-1, width) if width > 1 else array


def _view(document: Json, binary: bytes, index: int) -> bytes:
    one = document["bufferViews"][index]
    return binary[one["byteOffset"] : one["byteOffset"] + one["byteLength"]]
