"""Photographs and a list become a manifest, and a manifest becomes a plan of work.

In: files and CSV. Out: `manifest.csv` and `.parquet`; then photos and blocks to build.
Open `index` first, then `manifest`.
"""

from pipelines.index.again import (
    Kept,
    Wish,
    drafted,
    fulfilled,
    known,
    outdated,
    renewed,
)
from pipelines.index.anchors import Anchors, keep, load, told_of_places
from pipelines.index.images import Nothing
from pipelines.index.index import Indexed, Question, index
from pipelines.index.profiles import PROFILE, of_city
from pipelines.index.sweeping import seldom
from pipelines.index.title import cleaned, of_folder
from pipelines.index.watermarks import content as watermark_content
from pipelines.index.watermarks import known as known_watermarks
from pipelines.index.watermarks import loaded as loaded_watermark
from pipelines.index.watermarks import sha256 as watermark_sha256
from pipelines.index.witnesses import Ask, Heard

__all__ = [
    "PROFILE",
    "Anchors",
    "Ask",
    "Heard",
    "Indexed",
    "Kept",
    "Nothing",
    "Question",
    "Wish",
    "cleaned",
    "drafted",
    "fulfilled",
    "index",
    "keep",
    "known",
    "known_watermarks",
    "load",
    "loaded_watermark",
    "of_city",
    "of_folder",
    "outdated",
    "renewed",
    "seldom",
    "told_of_places",
    "watermark_content",
    "watermark_sha256",
]
