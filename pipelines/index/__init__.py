"""Photographs and a list become a manifest, and a manifest becomes a plan of work.

In: files and CSV. Out: `manifest.csv` and `.parquet`; then photos and blocks to build.
Open `index` first, then `manifest`.
"""

from pipelines.index.anchors import Anchors, Asked, load, told_of_places
from pipelines.index.images import Nothing
from pipelines.index.index import Indexed, index
from pipelines.index.title import cleaned, of_folder

__all__ = [
    "Anchors",
    "Asked",
    "Indexed",
    "Nothing",
    "cleaned",
    "index",
    "load",
    "of_folder",
    "told_of_places",
]
