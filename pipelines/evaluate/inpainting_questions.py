"""Pictures with holes whose truth is known: labelled fronts, or any folder of images.

The project's data folder gives its held-out fronts, straightened: files that no
training saw. A folder with `photos/` and `labels/` gives all of its fronts. Any other
folder gives its images as they are, at most 640 px long, in gray. A picture's holes are
drawn from a generator seeded by its name, so that a question never changes.
"""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from nostalgin_core.arrays import Gray, Mask
from nostalgin_core.measure.inpainting import Question, answerable, ask, ask_at_foot
from nostalgin_core.measure.labelled_fronts import (
    HELD_OUT_BLOCK,
    LARGEST_PX,
    held_out,
    straightened,
)
from nostalgin_core.measure.standing import Outline, silhouettes
from pipelines.evaluate import Unmeasurable
from pipelines.evaluate.labels import PICTURES, pairs

LABELLED = ("taxphotos", "historic_streets")
HOLES = ("free", "foot")


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """One question, and what it is about."""

    name: str
    holes: str  # one of `HOLES`
    question: Question


def labelled(folder: Path) -> bool:
    """Tell whether a folder holds labelled photographs."""
    return (folder / "labels").is_dir() and (folder / "photos").is_dir()


def kind(folder: Path) -> str:
    """Say what a folder's pictures are, in words for the report."""
    if any(labelled(folder / name) for name in LABELLED):
        return "held-out fronts"
    return "labelled fronts" if labelled(folder) else "plain images"


def asked(
    folder: Path, *, holes: tuple[str, ...] = HOLES, most: int | None = None
) -> list[Asked]:
    """Ask about a folder's pictures, at most so many of them, evenly spread.

    Raises:
        Unmeasurable: if there is no such folder, nothing in it to ask about, or no
            labelled people and cars for holes at the foot.
    """
    if not folder.is_dir():
        raise Unmeasurable(f"{folder} is no folder: name one with images in it")
    pictures = list(_pictures(folder))
    if most is not None and most < len(pictures):
        kept = np.linspace(0, len(pictures) - 1, most).round().astype(int)
        pictures = [pictures[n] for n in kept]
    outlines = _outlines(folder) if "foot" in holes else ()
    if "foot" in holes and not outlines:
        raise Unmeasurable(
            f"{folder} has no labelled people or cars to stand before a front: "
            "use --holes free, or a folder with photos/ and labels/"
        )
    questions = [
        Asked(name, one, _ask(name, one, image, known, outlines))
        for name, image, known in pictures
        for one in holes
    ]
    made = [one for one in questions if answerable(one.question)]
    if not made:
        raise Unmeasurable(
            f"{folder} has no picture to ask about: name a folder with images "
            f"({', '.join(PICTURES)}), or with photos/ and labels/"
        )
    return made


def _ask(
    name: str, holes: str, image: Gray, known: Mask, outlines: tuple[Outline, ...]
) -> Question:
    """Draw a hole of one kind, the same for the same name."""
    digest = hashlib.sha256(f"{name}/{holes}".encode()).digest()
    rng = np.random.default_rng(list(digest[:8]))
    if holes == "foot":
        return ask_at_foot(image, known, outlines, rng=rng)
    return ask(image, known, rng=rng)


def _pictures(folder: Path) -> Iterator[tuple[str, Gray, Mask]]:
    """Read the pictures: their name, the picture, and what is known of it."""
    if kind(folder) == "held-out fronts":
        for name in filter(lambda name: labelled(folder / name), LABELLED):
            yield from _fronts(folder / name, only_held_out=True)
    elif labelled(folder):
        yield from _fronts(folder, only_held_out=False)
    else:
        yield from _plain(folder)


def _fronts(folder: Path, *, only_held_out: bool) -> Iterator[tuple[str, Gray, Mask]]:
    """Straighten the labelled fronts of a folder."""
    for label, photo in pairs(folder):
        stem = label["id"]
        if only_held_out and not held_out(folder.name, stem):
            continue
        for number, image, known in straightened(_read(photo), label["objects"]):
            yield f"{folder.name}/{stem}/{number}", image, known


def _plain(folder: Path) -> Iterator[tuple[str, Gray, Mask]]:
    """Read images as they are, gray, the large ones smaller."""
    for path in sorted(folder.rglob("*")):
        if path.suffix.lower() not in PICTURES:
            continue
        image = _read(path)
        shrink = min(1.0, LARGEST_PX / max(image.shape))
        if shrink < 1.0:
            image = cv2.resize(
                image, None, fx=shrink, fy=shrink, interpolation=cv2.INTER_AREA
            ).astype(np.uint8, copy=False)
        yield str(path.relative_to(folder)), image, np.ones(image.shape, bool)


def _read(path: Path) -> Gray:
    """Read an image in gray.

    Raises:
        Unmeasurable: if it is none.
    """
    image = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if image is None:
        raise Unmeasurable(f"{path} can't be read as an image: take it out")
    return image.astype(np.uint8, copy=False)


def _outlines(folder: Path) -> tuple[Outline, ...]:
    """Take the silhouettes of all labelled people, cars and posts, block 993's not."""
    places = [folder, *(folder / name for name in LABELLED)]
    return tuple(
        outline
        for place in places
        if labelled(place)
        for label, _ in pairs(place)
        if not label["id"].startswith(HELD_OUT_BLOCK)
        for outline in silhouettes(label["objects"])
    )
