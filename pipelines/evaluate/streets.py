"""Painted streets: how near are quads and proportions, and do stated intervals hold?

Rectification gets the painter's masks. On fronts that lie wholly in the frame: how far
corners are off, in pixels and in hundredths of the front's width, and by how many
hundredths the aspect ratio is. On all fronts: how often the truth lies within 1.96
stated standard deviations (`measure.coverage`) of

- the horizontal vanishing point and the vertical one, as angles through the true camera
  (their stated deviation is of both directions together, so 95 % is the least);
- the focal length, where the lines tell it;
- the aspect ratio of what the quad bounds of a front, against the same in truth.

A photo's focal length and vertical point are stated once and counted once.
"""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from nostalgin_core import rectify
from nostalgin_core.measure import coverage
from nostalgin_core.measure import rectification as measure
from nostalgin_core.records import Elevation, Rejection
from nostalgin_core.rectify import lines
from pipelines.evaluate.painted import SEED, Painted, paintings

QUANTITIES: Final = ("horizontal", "vertical", "focal", "aspect")
UNITS: Final = {
    "horizontal": "degrees",
    "vertical": "degrees",
    "focal": "% of it",
    "aspect": "% of it",
}


@dataclass(frozen=True, slots=True)
class Residual:
    """What one elevation states of a quantity, and by how much it errs."""

    quantity: str
    method: str
    error: float
    sd: float


@dataclass(frozen=True, slots=True)
class Outline:
    """How near one front's quad is; for fronts wholly in the frame."""

    corners_px: float
    corners_percent: float  # of the front's width
    aspect_percent: float
    worst_deg: float


def evaluate(
    detectors: dict[str, lines.Detector],
    *,
    fronts: int,
    seed: int = SEED,
    keep: Path | None = None,
) -> dict[str, Any]:
    """Measure rectification with each detector of lines on so many painted fronts."""
    outlines: dict[str, list[Outline]] = {name: [] for name in detectors}
    residuals: dict[str, list[Residual]] = {name: [] for name in detectors}
    reasons: dict[str, Counter[str]] = {name: Counter() for name in detectors}
    photos = complete = shown = 0
    for one in paintings(fronts, seed=seed, keep=keep):
        photos += 1
        shown += len(one.quads)
        complete += int(one.complete.sum())
        for name, detector in detectors.items():
            results = rectify.rectify(one.photo, one.matted, detector=detector)
            outlines[name] += outlined(one, results)
            residuals[name] += stated(one, results)
            reasons[name].update(r.reason for r in results if isinstance(r, Rejection))
    about = {"photographs": photos, "fronts": shown, "complete_fronts": complete}
    return {
        name: about
        | {"rejections": dict(sorted(reasons[name].items()))}
        | summed(outlines[name])
        | {"coverage": covered(residuals[name])}
        for name in detectors
    }


def outlined(
    painted: Painted, results: tuple[Elevation | Rejection, ...]
) -> list[Outline]:
    """Compare the quads of the fronts that lie wholly in the frame."""
    found = []
    for i, one in enumerate(results):
        if not isinstance(one, Elevation) or not painted.complete[i]:
            continue
        true = painted.quads[i]
        off = measure.corner_error_px(one.quad, true)
        found.append(
            Outline(
                off,
                100 * off / measure.width_px(true),
                100 * abs(one.aspect / float(painted.aspects[i]) - 1),
                measure.worst_angle_deg(true, one.photo_from_elevation),
            )
        )
    return found


def stated(
    painted: Painted, results: tuple[Elevation | Rejection, ...]
) -> list[Residual]:
    """List what the elevations of one photo state, with its error."""
    found: list[Residual] = []
    seen: set[tuple[str, float]] = set()

    def add(quantity: str, one: Elevation, error: float, sd: float) -> None:
        shared = quantity in ("vertical", "focal")
        if not (shared and (quantity, round(error, 6)) in seen):
            found.append(Residual(quantity, one.method, error, sd))
        seen.add((quantity, round(error, 6)))

    for i, one in enumerate(results):
        if not isinstance(one, Elevation):
            continue
        for rank, quantity in enumerate(("horizontal", "vertical")):
            angle = measure.angle_deg(
                one.vanishing_points[rank],
                painted.vanishing_points[i, rank],
                painted.camera,
            )
            add(quantity, one, angle, one.vanishing_sd_deg[rank])
        if one.focal_px is not None and one.focal_sd_px is not None:
            focal = float(painted.camera[0, 0])
            error = 100 * (one.focal_px / focal - 1)
            add("focal", one, error, 100 * one.focal_sd_px / focal)
        true = measure.bounded_aspect(
            one.quad, painted.quads[i], float(painted.aspects[i])
        )
        add("aspect", one, 100 * (one.aspect / true - 1), 100 * one.aspect_sd / true)
    return found


def summed(outlines: list[Outline]) -> dict[str, Any]:
    """Sum up how near the quads are: medians and 90th percentiles."""
    summary: dict[str, Any] = {"straightened": len(outlines)}
    for name in Outline.__dataclass_fields__:
        values = [getattr(one, name) for one in outlines]
        for word, share in (("median", 0.5), ("p90", 0.9)):
            key = f"{name}_{word}"
            summary[key] = float(np.quantile(values, share)) if values else None
    return summary


def covered(residuals: list[Residual]) -> dict[str, Any]:
    """Sum up each quantity's coverage: over all, and by how a direction was found."""
    methods = sorted({one.method for one in residuals})
    table: dict[str, Any] = {}
    for quantity in QUANTITIES:
        mine = [one for one in residuals if one.quantity == quantity]
        groups = {"all": mine}
        groups |= {m: [one for one in mine if one.method == m] for m in methods}
        for method, group in groups.items():
            result = coverage.coverage(
                np.array([one.error for one in group]),
                np.array([one.sd for one in group]),
            )
            if result is not None:
                rows = table.setdefault(quantity, {})
                rows[method] = result._asdict()
    return table
