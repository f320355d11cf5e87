"""What was found of a photo's fronts, as outlines and quads, from its artifacts."""

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import cv2
import numpy as np
import shapely

from nostalgin_core.arrays import Mask
from nostalgin_core.records import Facade
from pipelines import bounded
from pipelines.corrections.shapes import Points
from pipelines.store import Damaged, Store, runs, tables
from pipelines.store.refuse import record
from pipelines.store.versions import Versions

NUMBERS: Final = ("facade", "quad", "aspect", "reason")
COARSE_PX: Final = 2.0  # by which an outline may leave its mask


@dataclass(frozen=True, eq=False)
class Found:
    """One front of a photograph, in its pixels."""

    target: bool
    outline: Points
    area_px: int  # of the whole front, what stands before it included
    quad: Points | None = None  # None: it could not be straightened
    aspect: float | None = None  # width over height

    def like(self, points: Points) -> tuple[float, bool]:
        """Tell how much of a shape and of the front both share; targets come first."""
        own, other = shapely.Polygon(self.outline), shapely.Polygon(points)
        own, other = own.buffer(0), other.buffer(0)
        either = own.union(other).area
        return own.intersection(other).area / either if either else 0.0, self.target


def published(store: Store) -> Versions | None:
    """Read the versions of the run that is shown, if one is."""
    try:
        run = runs.shown(store)
        return Versions(**record(store, run)["versions"])
    except (OSError, KeyError, TypeError, UnicodeDecodeError):
        return None


def content(root: str, photo: str) -> str:
    """Hash a photograph; empty where it can't be read."""
    try:
        data = Store(root).read_bytes(photo, bounded.PHOTO_BYTES)
    except (OSError, ValueError):
        return ""
    return hashed(data)


def hashed(data: bytes) -> str:
    """Hash a photograph's bytes, as keys have it."""
    return hashlib.sha256(data).hexdigest()


def found(
    store: Store, versions: Versions, sha256: str, outline: str = "", quad: str = ""
) -> tuple[Found, ...]:
    """List the fronts of a photograph, as drawn or as found; none if none is built."""
    matted = versions.path("matte", versions.matte_key(sha256, outline))
    rectified = versions.path("rectify", versions.rectify_key(sha256, outline, quad))
    views = {
        row["facade"]: row
        for row in rows(store, rectified, NUMBERS)
        if row["reason"] is None
    }
    facades = [
        tables.from_row(Facade, row)
        for row in rows(store, matted)
        if row["category"] is None
    ]
    return tuple(of(one, views.get(one.index)) for one in facades)


def of(one: Facade, view: dict[str, Any] | None) -> Found:
    """Sum up a front."""
    quad = None if view is None else np.array(view["quad"], np.float64).reshape(4, 2)
    return Found(
        target=one.target,
        outline=outlined(one.amodal),
        area_px=int(np.count_nonzero(one.amodal)),
        quad=quad,
        aspect=None if view is None else view["aspect"],
    )


def outlined(mask: Mask) -> Points:
    """Draw the outline of a mask's largest part, with few points."""
    parts, _ = cv2.findContours(
        mask.astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE
    )
    if not parts:
        return np.zeros((0, 2))
    largest = max(parts, key=cv2.contourArea)
    return cv2.approxPolyDP(largest, COARSE_PX, closed=True)[:, 0].astype(np.float64)


def rows(
    store: Store, path: str, columns: Sequence[str] | None = None
) -> list[dict[str, Any]]:
    """Read an artifact; one that is not there, or is a rejection, has no rows."""
    try:
        if store.verdict(path) is not True:
            return []
        return store.read_table(path, columns).to_pylist()
    except (Damaged, OSError):
        return []
