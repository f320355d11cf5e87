"""What is rare in labelled photographs is painted onto those there are.

The fronts that the network misses are of a few kinds: low ones before a taller party
wall, theatres under a marquee, what stands behind an elevated railway, towers in haze,
rows seen at a grazing angle, corners seen along one side, ground floors that stand out.
Each kind is one small change of a photograph whose labels are known, so that they stay
true to the pixel. The film's border and a print's white margin stay as they are.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from export.rare_kinds import grazing, hazy, marquee, railway, walled
from export.rare_shapes import cornered, projecting
from export.segmentation_data import Sample
from nostalgin_core.photo import exposed

Kind = Callable[[Sample, np.random.Generator], Sample]
KINDS: Final[dict[str, Kind]] = {
    "walled": walled,
    "marquee": marquee,
    "railway": railway,
    "hazy": hazy,
    "grazing": grazing,
    "cornered": cornered,
    "projecting": projecting,
}
MIXED: Final = ("walled", *KINDS)  # walls twice, since they are missed most


def rare(
    sample: Sample, rng: np.random.Generator, kinds: Sequence[str] = MIXED
) -> Sample:
    """Make a photograph one of the rare kinds, or leave it where it can't be one.

    A kind that is named twice is drawn twice as often.
    """
    kind = KINDS[kinds[int(rng.integers(len(kinds)))]]
    x0, y0, x1, y1 = exposed(sample.image)
    inside = replace(_moved(sample, -x0, -y0), image=sample.image[y0:y1, x0:x1])
    changed = kind(inside, rng)
    image = sample.image.copy()
    image[y0:y1, x0:x1] = changed.image
    return replace(_moved(changed, x0, y0), image=image)


def _moved(sample: Sample, x: int, y: int) -> Sample:
    step = np.array([x, y], float)
    things = (replace(t, rings=tuple(r + step for r in t.rings)) for t in sample.things)
    return replace(sample, things=tuple(things))
