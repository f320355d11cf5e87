"""Fronts by size, by angle of view, by what went wrong, and how sure targets are.

Average precision of fronts (overlap of a half) is told for three sizes, shares of the
photo that are visible, and three angles of view, between the front's normal and the ray
to its middle, by the labelled quad and the prior focal length. Wrong claims count among
the size that they have themselves, and among the angle of the front that they overlap
most; one that overlaps none counts among every angle.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from jaxtyping import Bool

from nostalgin_core.arrays import Mask
from nostalgin_core.measure.calibration import reliability
from nostalgin_core.measure.detection import (
    Matches,
    average_precision,
    matches_of_kind,
    table,
    together,
)
from nostalgin_core.measure.front_errors import FATES, Errors, errors
from nostalgin_core.measure.segmentation import overlap
from nostalgin_core.records import Facade, Matted
from pipelines.evaluate.labels import Truth

FOUND: Final = 0.5
SIZES: Final = {
    "below 0.03": (0.0, 0.03),
    "0.03 to 0.1": (0.03, 0.1),
    "above 0.1": (0.1, np.inf),
}
ANGLES_DEG: Final = {
    "below 30": (0.0, 30.0),
    "30 to 60": (30.0, 60.0),
    "above 60": (60.0, np.inf),
}
WRONG: Final = (*FATES[1:], "wall")


@dataclass(frozen=True, slots=True)
class Stated:
    """What was stated of one front of a photo with a labelled target."""

    probability: float
    called: bool
    target: bool  # it overlaps a labelled one by a half or more


@dataclass(frozen=True, slots=True, eq=False)
class Kinds:
    """One photo's share of the tables."""

    sizes: dict[str, Matches]
    angles_deg: dict[str, Matches]
    errors: Errors
    stated: tuple[Stated, ...]


def kinds(
    scores: Sequence[float], masks: Sequence[Mask], matted: Matted, true: Truth
) -> Kinds:
    """Sort what was found in one photo.

    Args:
        scores: Of the network's fronts.
        masks: Of the same, before anything is arranged.
        matted: What the stages made of them.
        true: What the label says.
    """
    fronts = [one for one in true.fronts if one.visible.any()]
    truths = [one.visible for one in fronts]
    pixels = true.far.size
    own = np.array([np.count_nonzero(one) / pixels for one in masks])
    theirs = np.array([np.count_nonzero(one) / pixels for one in truths])
    angle = np.array(
        [np.nan if one.view_deg is None else one.view_deg for one in fronts]
    )
    overlaps = table(masks, truths)
    touched = overlaps.max(axis=1, initial=0) > 0
    near = (
        np.where(touched, angle[overlaps.argmax(axis=1)], np.nan)
        if truths
        else np.full(len(masks), np.nan)
    )

    def among(asked: np.ndarray, counted: np.ndarray) -> Matches:
        return matches_of_kind(
            scores, masks, truths, true.far, asked=asked, counted=counted, least=FOUND
        )

    seen = [one.mask & ~true.hidden for one in matted.facades]
    return Kinds(
        {n: among(_in(theirs, s), _in(own, s)) for n, s in SIZES.items()},
        {
            n: among(_in(angle, span), ~touched | _in(near, span))
            for n, span in ANGLES_DEG.items()
        },
        errors(seen, truths, true.far),
        stated(matted.facades, true),
    )


def stated(facades: Sequence[Facade], true: Truth) -> tuple[Stated, ...]:
    """Tell of each front found how likely it was called, and whether rightly."""
    aims = [one.visible for one in true.fronts if one.target]
    if not aims:
        return ()
    return tuple(
        Stated(
            float(one.target_score),
            one.target,
            any(overlap(one.mask & ~true.hidden, aim) >= FOUND for aim in aims),
        )
        for one in facades
    )


def summed(rows: Sequence[tuple[str, Kinds]]) -> dict[str, Any]:
    """Sum up the tables of photos, each with its name."""
    every = [kind for _, kind in rows]
    return {
        "facades_by_size": _precisions([one.sizes for one in every]),
        "facades_by_angle_deg": _precisions([one.angles_deg for one in every]),
        "errors": {
            "fronts": sum(len(one.errors.fates) for one in every),
            "claimed": sum(len(one.errors.walls) for one in every),
        }
        | {
            kind: {
                "count": sum(count(one.errors, kind) for one in every),
                "photos": [name for name, one in rows if count(one.errors, kind)],
            }
            for kind in WRONG
        },
        "target_probability": _calibrated([one.stated for one in every]),
    }


def count(told: Errors, kind: str) -> int:
    """Count one kind of error in one photo."""
    return sum(told.walls) if kind == "wall" else told.fates.count(kind)  # type: ignore[arg-type]


def _in(values: np.ndarray, span: tuple[float, float]) -> Bool[np.ndarray, " n"]:
    """Tell which lie in a span; what is not known lies in none."""
    return (values >= span[0]) & (values < span[1])


def _precisions(parts: Sequence[dict[str, Matches]]) -> dict[str, dict[str, Any]]:
    result = {}
    for name in parts[0] if parts else ():
        found = together([one[name] for one in parts])
        value = average_precision(found)
        result[name] = {
            "labelled": found.truths,
            "AP50": None if np.isnan(value) else value,
            "found": int(found.hits.sum()),
        }
    return result


def _calibrated(photos: Iterable[tuple[Stated, ...]]) -> dict[str, Any]:
    """Hold what was stated of fronts against their labels, and count those called."""
    told = [photo for photo in photos if photo]
    every = [one for photo in told for one in photo]
    first = [max(photo, key=lambda one: one.probability) for photo in told]
    told_of = reliability(
        [one.probability for one in every], [one.target for one in every]
    )
    result: dict[str, Any] = {
        "photos": len(told),
        "called": sum(any(one.called for one in photo) for photo in told),
        "called_rightly": sum(
            any(one.called and one.target for one in photo) for photo in told
        ),
        "first_right": sum(one.target for one in first),
    }
    if told_of is None:
        return result | {"brier": None, "error": None, "bins": []}
    bins = [one._asdict() for one in told_of.bins]
    return result | {"brier": told_of.brier, "error": told_of.error, "bins": bins}
