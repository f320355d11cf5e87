"""Holes to learn on: people, cars and posts standing at the foot of a front.

How they stand is told in `nostalgin_core.measure.standing`; here their outlines are
read. Free-form strokes are drawn by `nostalgin_core.measure.free_form`.
"""

import json
from pathlib import Path

from nostalgin_core.measure.labelled_fronts import HELD_OUT_BLOCK
from nostalgin_core.measure.standing import Outline, silhouettes, standing

__all__ = ["Outline", "outlines", "standing"]


def outlines(data: Path) -> tuple[Outline, ...]:
    """Read the silhouettes of all labelled people, cars and posts, block 993's not."""
    return tuple(
        outline
        for folder in ("taxphotos", "historic_streets")
        for path in sorted((data / folder / "labels").glob("*.json"))
        if not path.stem.startswith(HELD_OUT_BLOCK)
        for outline in silhouettes(json.loads(path.read_text())["objects"])
    )
