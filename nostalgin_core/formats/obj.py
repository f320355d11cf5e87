"""A zip that old programs take: exactly one OBJ, its MTL and its images.

Vertices are the GLB's own, in its axes: x east, y up, z south, in metres. The material
`photograph` is worn; `evidence` is there to be put in its place. Words of others never
come into the OBJ or MTL, where a line break would be a command.
"""

import io
import json
import zipfile
from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from nostalgin_core.formats.shown import Shown, png, tinted

EPOCH: Final = (1980, 1, 1, 0, 0, 0)  # the first that a zip can tell
HEAD: Final = "# nostalgin: metres, x east, y up, z south; rights in {}.json\n"
MATERIAL: Final = "newmtl {}\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 0\nmap_Kd {}\n"


def archive(shown: Shown, name: str, *, told: Mapping[str, Any]) -> bytes:
    """Zip a block. `name` is harmless in a file's name; `told` goes to its JSON."""
    colours, opacity = f"{name}.png", f"{name}-opacity.png"
    material = MATERIAL.format("photograph", colours) + f"map_d {opacity}\n\n"
    material += MATERIAL.format("evidence", f"{name}-evidence.png")
    files = {
        f"{name}.obj": _obj(shown, name).encode(),
        f"{name}.mtl": material.encode(),
        colours: png(shown.colours),
        opacity: png(shown.colours[..., 3]),
        f"{name}-evidence.png": png(tinted(shown.evidence)),
        f"{name}.json": json.dumps(told, indent=1, sort_keys=True).encode(),
    }
    sink = io.BytesIO()
    with zipfile.ZipFile(sink, "w") as made:
        for file, data in files.items():
            entry = zipfile.ZipInfo(file, EPOCH)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.create_system = 3  # the same on every machine
            made.writestr(entry, data, compresslevel=6)
    return sink.getvalue()


def _obj(shown: Shown, name: str) -> str:
    lines = [HEAD.format(name), f"mtllib {name}.mtl\n"]
    vertex = 1
    shells = [*shown.shells, *([shown.ground] if shown.ground else [])]
    for number, shell in enumerate(shells):
        lines.append(f"o {_word(shell.name) or number}\nusemtl photograph\n")
        for one in shell.surfaces:
            east, north, up = one.corners_m.T
            rows = np.column_stack([east, up, -north]) + 0.0
            lines += [f"v {x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in rows.tolist()]
            lines += [f"vt {u:.7f} {1.0 - v:.7f}\n" for u, v in one.uvs.tolist()]
            count = len(rows)
            corners = " ".join(f"{k}/{k}" for k in range(vertex, vertex + count))
            lines.append(f"f {corners}\n")
            vertex += count
    return "".join(lines)


def _word(name: str) -> str:
    """Keep of a building's name what can't be taken for a command."""
    return "".join(letter if letter.isalnum() else "-" for letter in name)[:64]
