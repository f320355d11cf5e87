"""Fills are compared with what was really there as the paper's table 3 does.

Over the texels of the hole whose truth is known, with gray levels from 0 to 1:
l1 = mean |made - true| and l2 = mean (made - true)^2, both in hundredths; a method's
figures are their mean and standard deviation over pictures. Such figures hardly tell
methods apart (paper, section 4.3), so a classical method stands beside them always.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import cv2
import numpy as np
from skimage.restoration import inpaint_biharmonic

from nostalgin_core import evidence
from nostalgin_core.arrays import EvidenceMap, Gray, Mask
from nostalgin_core.inpaint.inpaint import Network, low_memory, whole
from nostalgin_core.inpaint.repetition import guess
from nostalgin_core.inpaint.smooth import fill
from nostalgin_core.measure.free_form import free_form_share
from nostalgin_core.measure.standing import Outline, standing
from nostalgin_core.records import Elevation

Fill = Callable[[Gray, Mask], Gray]

RADIUS_PX = 3  # of the classical methods (paper, appendix)
LEAST_SCORED_PX = 50  # fewer would be chance
LEAST_SEEN = 0.15  # of a picture: with less, nobody could tell


class Question(NamedTuple):
    """A picture with a hole, and where the answer is known."""

    image: Gray
    hole: Mask
    scored: Mask


class Marks(NamedTuple):
    """How far a fill is from the truth, in hundredths."""

    l1: float
    l2: float


def ask(image: Gray, known: Mask, *, rng: np.random.Generator) -> Question:
    """Draw free-form strokes over 20 to 30 % of a picture."""
    hole = free_form_share(image.shape, least=0.2, most=0.3, rng=rng)
    return Question(image, hole | ~known, hole & known)


def ask_at_foot(
    image: Gray,
    known: Mask,
    outlines: Sequence[Outline],
    *,
    rng: np.random.Generator,
) -> Question:
    """Stand people and cars before a front."""
    hole = standing(image.shape, outlines, rng=rng)
    return Question(image, hole | ~known, hole & known)


def answerable(question: Question) -> bool:
    """Tell whether there is anything to score, and anything to fill it from."""
    seen = (~question.hole).mean()
    return bool(question.scored.sum() >= LEAST_SCORED_PX and seen > LEAST_SEEN)


def mark(made: Gray, question: Question) -> Marks:
    """Compare a fill with the truth."""
    off = (made.astype(float) - question.image)[question.scored] / 255
    return Marks(100 * float(np.abs(off).mean()), 100 * float(np.square(off).mean()))


def summary(marks: list[Marks]) -> tuple[Marks, Marks]:
    """Give the mean and the standard deviation over pictures."""
    table = np.array(marks)
    return Marks(*table.mean(0).tolist()), Marks(*table.std(0).tolist())


def navier_stokes(image: Gray, hole: Mask) -> Gray:
    """Fill by the classical method that all others are measured against."""
    return cv2.inpaint(image, hole.astype(np.uint8), RADIUS_PX, cv2.INPAINT_NS)


def telea(image: Gray, hole: Mask) -> Gray:
    """Fill by fast marching."""
    return cv2.inpaint(image, hole.astype(np.uint8), RADIUS_PX, cv2.INPAINT_TELEA)


def biharmonic(image: Gray, hole: Mask) -> Gray:
    """Fill by a plate that is bent as little as can be."""
    return _gray(255 * inpaint_biharmonic(image / 255, hole))


def membrane(image: Gray, hole: Mask) -> Gray:
    """Fill by our membrane alone."""
    return _gray(fill(np.where(hole, 0, image).astype(np.float32), hole))


def repeated(image: Gray, hole: Mask) -> Gray:
    """Fill by what repeats, without the network."""
    return _gray(guess(np.where(hole, 0, image).astype(np.float32), hole))


def _gray(values: np.ndarray) -> np.ndarray:
    """Round to gray levels."""
    return np.clip(np.round(values), 0, 255).astype(np.uint8)


def elevation(image: Gray, marks: EvidenceMap) -> Elevation:
    """Dress a picture as an elevation whose camera nobody asks for."""
    return Elevation(
        facade=0,
        image=image,
        alpha=(marks == evidence.PHOTOGRAPHED).astype(np.float32),
        evidence=marks,
        quad=np.zeros((4, 2)),
        photo_from_elevation=np.eye(3),
        vanishing_points=np.zeros((2, 3)),
        focal_px=None,
        aspect=image.shape[1] / image.shape[0],
        vanishing_sd_deg=(0.0, 0.0),
        focal_sd_px=None,
        aspect_sd=0.0,
        method="measured",
    )


def methods(network: Network) -> dict[str, Fill]:
    """Name every method of the table, ours last."""

    def ours(image: Gray, hole: Mask, how: Callable[..., Elevation]) -> Gray:
        marks = np.where(hole, evidence.INPAINTED, evidence.PHOTOGRAPHED)
        return how(elevation(image, marks.astype(np.uint8)), network).image

    return {
        "Navier-Stokes": navier_stokes,
        "Telea": telea,
        "biharmonic": biharmonic,
        "membrane": membrane,
        "repetition": repeated,
        "ours, whole": lambda image, hole: ours(image, hole, whole),
        "ours, low memory": lambda image, hole: ours(image, hole, low_memory),
    }
