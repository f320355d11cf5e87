"""Painted streets: a 1940s neighbourhood with exact truth for every photo of it."""

from nostalgin_core.scenes.catalogue import catalogue_rows, photo_name
from nostalgin_core.scenes.flaws import Flaws
from nostalgin_core.scenes.lot import Lot
from nostalgin_core.scenes.photograph import album, photograph
from nostalgin_core.scenes.street import Neighbourhood, PaintedBlock, neighbourhood
from nostalgin_core.scenes.truth import PaintedPhoto, TrueFacade, TrueOccluder, Truth

__all__ = [
    "Flaws",
    "Lot",
    "Neighbourhood",
    "PaintedBlock",
    "PaintedPhoto",
    "TrueFacade",
    "TrueOccluder",
    "Truth",
    "album",
    "catalogue_rows",
    "neighbourhood",
    "photo_name",
    "photograph",
]
