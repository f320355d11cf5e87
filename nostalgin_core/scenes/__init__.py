"""Painted streets: a 1940s neighbourhood with exact truth for every photo of it.

In: a seed. Out: lots, an archive's list, photographs and what is true of each.
No paper's: tests, training and `nostalgin demo` live on it. Open `street` first, then
`photograph`.
"""

from nostalgin_core.scenes.catalogue import catalogue_rows, photo_name
from nostalgin_core.scenes.flaws import Flaws
from nostalgin_core.scenes.lot import Lot
from nostalgin_core.scenes.photograph import album, photograph
from nostalgin_core.scenes.street import Neighbourhood, neighbourhood
from nostalgin_core.scenes.truth import PaintedPhoto, TrueFacade, Truth

__all__ = [
    "Flaws",
    "Lot",
    "Neighbourhood",
    "PaintedPhoto",
    "TrueFacade",
    "Truth",
    "album",
    "catalogue_rows",
    "neighbourhood",
    "photo_name",
    "photograph",
]
