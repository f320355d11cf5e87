"""A painted neighbourhood, photographed: an archive that everybody may have."""

import csv
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from nostalgin_core import scenes
from nostalgin_core.scenes import (
    Lot,
    Neighbourhood,
    catalogue_rows,
    neighbourhood,
    photo_name,
)

SEED: Final = 1940
CREDIT: Final = "Painted for this demonstration"
TITLE: Final = "A painted neighbourhood"
JPEG_QUALITY: Final = 92  # an archive's scans are compressed as well


def painted(
    folder: Path, *, blocks: int = 2, seed: int = SEED, tell: Callable[[int, int], None]
) -> tuple[Path, Path]:
    """Paint an archive: photos and their catalogue.

    A photo that is there already is not painted again; `tell` hears how many are done.

    Returns: the folder of photos, and the catalogue.
    """
    city = neighbourhood(np.random.default_rng(seed), blocks=blocks)
    photos = folder / "photos"
    photos.mkdir(parents=True, exist_ok=True)
    wanted = list(views(city))
    for done, (lot, view) in enumerate(wanted, 1):
        path = photos / f"{photo_name(lot, view)}.jpg"
        if not path.exists():
            write(path, city, lot, view, seed)
        tell(done, len(wanted))
    listed = folder / "catalogue.csv"
    rows = catalogue_rows(city)
    with listed.open("w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    return photos, listed


def views(city: Neighbourhood) -> Iterator[tuple[Lot, int]]:
    """List every photo that the archive holds."""
    for block in city.blocks:
        for lot in block.lots:
            for view in range(lot.photos):
                yield lot, view


def write(path: Path, city: Neighbourhood, lot: Lot, view: int, seed: int) -> None:
    """Paint one photo, wholly or not at all; its seed is its own."""
    rng = np.random.default_rng([seed, int(lot.block), int(lot.lot), view])
    image = scenes.photograph(city, lot, rng, view=view).image
    _, code = cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY])
    partial = path.with_suffix(".partial")
    partial.write_bytes(code.tobytes())
    partial.replace(path)
