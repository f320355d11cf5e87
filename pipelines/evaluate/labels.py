"""Folders of hand-labelled photographs: `photos/*.jpg` beside `labels/ID.json`.

A label's `objects` have a `category` and a `polygon` in pixels of the photo. A facade's
polygon is drawn as if nothing stood before it; `target` marks the front that a tax
photo is a record of, `group` a far row that nobody can tell apart and nobody scores.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from nostalgin_core.arrays import Mask
from nostalgin_core.measure.rectification import view_deg
from nostalgin_core.records import Box
from nostalgin_core.rectify import camera
from pipelines.evaluate import Unmeasurable

PICTURES = (".jpg", ".jpeg", ".png", ".tif", ".tiff")


@dataclass(frozen=True, slots=True, eq=False)
class Front:
    """One labelled front."""

    whole: Mask  # as if nothing stood before it
    visible: Mask
    target: bool
    view_deg: float | None  # from straight on; None without a labelled quad


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """What a label says of every pixel."""

    fronts: tuple[Front, ...]
    hiders: tuple[tuple[str, Mask], ...]  # category and outline
    visible: Mask  # of all fronts
    built: Mask  # all fronts, hidden or not
    hidden: Mask  # all that stands before anything
    far: Mask  # groups, where there is no front: not to be scored


def pairs(folder: Path, *, block: str = "") -> list[tuple[dict[str, Any], Path]]:
    """Pair the labels of a folder, whose names start with `block`, with their photos.

    Raises:
        Unmeasurable: if there is no such folder, no label, or a label without a photo.
    """
    if not folder.is_dir():
        raise Unmeasurable(f"{folder} is no folder: name one with photos/ and labels/")
    labels = sorted((folder / "labels").glob(f"{block}*.json"))
    if not labels:
        wanted = f"labels/{block}*.json"
        raise Unmeasurable(
            f"{folder} has no {wanted}: name a folder with photos/ and labels/, one "
            "JSON file a photo" + (", or another --block" if block else "")
        )
    photos = [
        one
        for one in sorted((folder / "photos").glob("*"))
        if one.suffix.lower() in PICTURES
    ]
    return [(read(one), _photo_of(one, photos)) for one in labels]


def read(file: Path) -> dict[str, Any]:
    """Read one label.

    Raises:
        Unmeasurable: if it is not the JSON of a label.
    """
    try:
        label = json.loads(file.read_text(encoding="utf-8"))
        objects = label["objects"]
        for one in objects:
            _check(one)
    except (ValueError, KeyError, TypeError) as problem:
        raise Unmeasurable(
            f"{file} is no label ({problem!r}): it must be JSON with `objects`, each "
            "with a `category` and a `polygon`"
        ) from problem
    return {"id": file.stem} | label | {"objects": objects}


def _check(one: dict[str, Any]) -> None:
    """Insist on an object's category and outline.

    Raises:
        KeyError, TypeError, ValueError: if one is missing, or something else.
    """
    if not isinstance(one["category"], str):
        raise TypeError(f"category is {one['category']!r}")
    np.array(one["polygon"], np.float64).reshape(-1, 2)


def _photo_of(label: Path, photos: list[Path]) -> Path:
    """Find the photo whose name ends with the label's."""
    named = [one for one in photos if one.stem.endswith(label.stem)]
    if not named:
        folder = label.parent.parent / "photos"
        raise Unmeasurable(
            f"{label} has no photo: put it into {folder}, with a name that ends with "
            f"{label.stem}, or take the label out"
        )
    return min(named, key=lambda one: len(one.stem))


def truth(label: dict[str, Any], shape: tuple[int, int]) -> Truth:
    """Turn a label's outlines into masks: what is visible is what nothing hides."""
    outlines = [(one, filled(one["polygon"], shape)) for one in label["objects"]]
    facades = [(one, m) for one, m in outlines if one["category"] == "facade"]
    single = [(one, mask) for one, mask in facades if not one.get("group")]
    hiders = tuple(
        (one["category"], mask) for one, mask in outlines if one["category"] != "facade"
    )
    hidden = union([mask for _, mask in hiders], shape)
    built = union([mask for _, mask in single], shape)
    groups = union([mask for one, mask in facades if one.get("group")], shape)
    return Truth(
        fronts=tuple(
            Front(mask, mask & ~hidden, bool(one.get("target")), _view_deg(one, shape))
            for one, mask in single
        ),
        hiders=hiders,
        visible=built & ~hidden,
        built=built,
        hidden=hidden,
        far=groups & ~built,
    )


def _view_deg(one: dict[str, Any], shape: tuple[int, int]) -> float | None:
    """Tell at what angle a labelled front is seen, by the prior focal length."""
    if one.get("quad") is None:
        return None
    frame = Box(0, 0, shape[1], shape[0])
    seen_by = camera.matrix(camera.prior_focal_px(frame), frame)
    try:
        return view_deg(np.array(one["quad"], np.float64), seen_by)
    except np.linalg.LinAlgError:  # three corners in line: a guess far off
        return None


def union(masks: list[Mask], shape: tuple[int, int]) -> Mask:
    """Return what lies on any of the masks."""
    return np.any([np.zeros(shape, bool), *masks], axis=0)


def filled(polygon: list[list[float]], shape: tuple[int, int]) -> Mask:
    """Fill an outline, its corners rounded to whole pixels."""
    mask = np.zeros(shape, np.uint8)
    corners = np.rint(np.array(polygon, np.float64)).astype(np.int32)
    cv2.fillPoly(mask, [corners], 1)
    return mask.astype(bool)
