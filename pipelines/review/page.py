"""One page with its pictures, its style and its program in it, and nothing from afar.

The browser runs and draws what has the hashes that the page itself names: nothing that
a caption might bring.
"""

import base64
import hashlib
from importlib import resources
from typing import Final

import cv2
import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined

from pipelines.corrections.shapes import Points
from pipelines.review.review import Review

ROOM: Final = "pipelines.review"
FEWEST: Final = 4  # points of an outline
COARSE: Final = 0.006  # of a photo's longer side


def page(found: Review, *, title: str) -> str:
    """Write the page as HTML; names are escaped, whatever is in them."""
    environment = Environment(
        loader=PackageLoader(ROOM, ""),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"points": points, "coarse": coarse}
    style, program = (read(name) for name in ("page.css", "page.js"))
    template = environment.get_template("page.html")
    return template.render(
        title=title,
        found=found,
        style=style,
        program=program,
        style_hash=source(style),
        program_hash=source(program),
    )


def read(name: str) -> str:
    """Read what lies beside this file."""
    return (resources.files(ROOM) / name).read_text(encoding="utf-8")


def source(text: str) -> str:
    """Name a text as a content security policy does (CSP 3, section 2.3.1)."""
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def coarse(some: Points | None, size_px: tuple[int, int]) -> Points | None:
    """Leave out points of an outline that a hand would not miss."""
    if some is None or len(some) < FEWEST:
        return None
    away = COARSE * max(size_px)
    made = cv2.approxPolyDP(some.astype(np.float32), away, closed=True)[:, 0]
    return made.astype(np.float64) if len(made) >= FEWEST else some


def points(some: Points | None) -> str:
    """Write points as SVG does."""
    return "" if some is None else " ".join(f"{x:.1f},{y:.1f}" for x, y in some)
