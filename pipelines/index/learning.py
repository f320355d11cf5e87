"""An archive's own watermark is learnt from a folder of copies that bear it."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

import cv2
import numpy as np

from nostalgin_core import photo
from nostalgin_core.measure import overlays
from nostalgin_core.measure.overlays import Learnt
from nostalgin_core.records import Photo
from nostalgin_core.rectify import Watermark, unmarked
from pipelines import bounded
from pipelines.index import watermarks
from pipelines.index.images import images

MOST: Final = 200  # photographs that are looked at: more tell hardly more
SHOWN: Final = 3  # photographs on the sheet
SHEET_PX: Final = 560  # of the width of each
CONTRAST: Final = 3.0  # with which the tile is drawn


def learnt(folder: Path, words: str) -> tuple[Learnt, list[Photo]]:
    """Learn the watermark of a folder's photographs, and give those looked at.

    Raises:
        Nothing: if the folder holds no image.
        OSError: if one can't be read.
    """
    names, _ = images(folder, "")
    chosen = [names[n * len(names) // MOST] for n in range(MOST)]
    looked = list(read(folder, sorted(set(chosen))))
    return overlays.learnt([one.image for one in looked], words), looked


def read(folder: Path, names: Sequence[str]) -> Iterator[Photo]:
    """Read photographs; those that can't be decoded are left out."""
    for name in names:
        data = bounded.read(folder / name, bounded.PHOTO_BYTES)
        decoded = photo.decode(data, name=name)
        if isinstance(decoded, Photo):
            yield decoded


def written(mark: Watermark) -> tuple[bytes, Watermark]:
    """Write a watermark, and give it as it is read again."""
    data = watermarks.written(mark)
    return data, watermarks.read(data)


def sheet(mark: Watermark, looked: Sequence[Photo]) -> np.ndarray:
    """Draw the tile, and some photographs with the watermark and without it."""
    chosen = [looked[n * len(looked) // SHOWN] for n in range(SHOWN)]
    rows = [np.hstack([wide(one), wide(unmarked(one, mark)[0])]) for one in chosen]
    tile = np.clip(128 + CONTRAST * overlays.visible(mark), 0, 255).astype(np.uint8)
    spare = max(0, rows[0].shape[1] - tile.shape[1])
    tile = np.pad(tile, ((0, 0), (0, spare)), constant_values=128)
    return np.vstack([tile[:, : rows[0].shape[1]], *rows])


def wide(one: Photo) -> np.ndarray:
    """Bring a photograph to the sheet's width."""
    image = one.image
    size = SHEET_PX, max(1, round(image.shape[0] * SHEET_PX / image.shape[1]))
    return cv2.resize(image, size, interpolation=cv2.INTER_AREA)
