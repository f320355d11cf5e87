"""Footprints as GeoJSON (RFC 7946): degrees of WGS 84, exteriors anticlockwise.

The RFC knows no other coordinates, so a city that has no place on the globe has no
footprints in it. Beside our own names stand those of OpenStreetMap.
"""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from nostalgin_core.formats.located import Ground
from nostalgin_core.formats.shown import Shell

Json = dict[str, Any]

DIGITS: Final = 8  # of a degree: a millimetre


def footprint(
    shell: Shell, ground: Ground, *, attributes: Mapping[str, Any]
) -> Json | None:
    """Write one building; None where it has no ground.

    Raises:
        ValueError: if the city has no place on the globe.
    """
    if ground.degrees is None:
        raise ValueError("GeoJSON needs a place on the globe")
    flat = shell.footprint_m
    if flat is None:
        return None
    around = np.column_stack([flat, np.zeros(len(flat))])
    degrees = np.round(ground.degrees(around)[:, :2], DIGITS).tolist()
    tags = {"building": "yes", "height": f"{shell.height_m:.2f}"}
    return {
        "type": "Feature",
        "id": shell.name,
        "geometry": {"type": "Polygon", "coordinates": [[*degrees, degrees[0]]]},
        "properties": {**tags, **attributes},
    }
