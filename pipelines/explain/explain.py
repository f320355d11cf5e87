"""One photo through every stage, as pictures and numbers.

The file's name is never looked at: the picture must speak. What is written follows
`explain.schema.json`.
"""

import json
import os
import re
import resource
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, Final

import cv2
import numpy as np

from nostalgin_core import evidence, inpaint, quantise, steps
from nostalgin_core.arrays import Gray
from nostalgin_core.records import Drawn, Elevation, Facade, Instance, Photo, Rejection
from nostalgin_core.rectify import lines
from nostalgin_core.steps import Networks, Stages
from pipelines import bounded
from pipelines.explain import draw
from pipelines.explain.panel import panel

NAME: Final = "photo"  # what stages are told the photo is called
TOLD: Final = "explain.json"
OURS: Final = re.compile(
    r'"(facade_\d+_(?:mask|amodal|alpha|rectified|elevation|evidence)\.png'
    r'|occluder_\d+_[a-z]+\.png)"'
)
KIB: Final = 1024


class Unreadable(ValueError):  # noqa: N818 - it reads as what it is about
    """A file that is no photo, with what to do about it."""


def explain(
    data: bytes,
    out: Path,
    networks: Networks,
    *,
    started: float,
    every: bool = False,
    drawn: Drawn = steps.UNDRAWN,
) -> dict:
    """Take a photo through every stage and write all there is to see into a folder.

    The facades of other buildings than the photo is a record of are inpainted only if
    `every` facade is wanted; else their holes stay open, with evidence of nothing. What
    is `drawn` takes the place of what was found.

    The total counts from `started`, the process's CPU seconds when work on this photo
    began, so that it is honest about loading.

    Returns: what `explain.json` says.

    Raises:
        Unreadable: if the bytes are no photo.
    """
    seconds: dict[str, float] = {"load": time.process_time() - started}
    made = steps.gather(
        timed(steps.steps(data, networks, name=NAME, every=every, drawn=drawn), seconds)
    )
    if made.photo is None:
        raise Unreadable(made.rejections[0].reason + ": " + made.rejections[0].detail)
    out.mkdir(parents=True, exist_ok=True)
    clear(out)
    report = written(made, made.photo, out)
    before = time.process_time()
    pictures(made, out)
    seconds["draw"] = time.process_time() - before
    seconds["total"] = time.process_time() - started
    report["seconds"] = {stage: round(spent, 4) for stage, spent in seconds.items()}
    report["peak_rss_bytes"] = peak_rss_bytes()
    text = json.dumps(report, indent=1) + "\n"
    put(out / TOLD, text.encode())
    return report


def clear(out: Path) -> None:
    """Take away what an earlier photo left in a folder, and nothing else.

    That is what its explain.json names, under names that we give.
    """
    try:
        told = bounded.read(out / TOLD, bounded.LOCK_BYTES).decode()
    except (OSError, ValueError):
        return
    (out / TOLD).unlink()
    named = set(OURS.findall(told))
    named |= {name.replace("_evidence.", "_evidence_colours.") for name in named}
    for name in sorted(named | {"photo.png", "panel.png"}):
        if not (out / name).is_dir():
            (out / name).unlink(missing_ok=True)


def timed(
    results: Iterator[tuple[str, Any]], seconds: dict[str, float]
) -> Iterator[tuple[str, Any]]:
    """Pass results on, and note the CPU seconds between one and the next."""
    before = time.process_time()
    for stage, result in results:
        now = time.process_time()
        seconds[stage] = now - before
        yield stage, result
        before = time.process_time()


def peak_rss_bytes() -> int:
    """Tell the most memory this process has held; macOS counts bytes, Linux KiB."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else peak * KIB


def written(made: Stages, photo: Photo, out: Path) -> dict[str, Any]:
    """Write masks and elevations as PNGs, and tell their names and the numbers."""
    height, width = photo.image.shape
    facades = made.matted.facades if made.matted else ()
    rectified = {one.facade: one for one in made.rectified}
    finished = {one.facade: one for one in made.elevations}
    return {
        "photo": photo.key,
        "width": width,
        "height": height,
        "facades": [
            facade_entry(one, rectified.get(one.index), finished.get(one.index), out)
            for one in facades
        ],
        "occluders": occluder_entries(made, photo, out),
        "placard": None if made.placard is None else asdict(made.placard),
        "rejections": [rejection_entry(one) for one in made.rejections],
    }


def facade_entry(
    facade: Facade, view: Elevation | None, done: Elevation | None, out: Path
) -> dict[str, Any]:
    """Tell what is known of one facade; without an elevation the numbers are null."""
    name = f"facade_{facade.index}"
    entry: dict[str, Any] = {
        "score": float(np.clip(facade.score, 0, 1)),
        "target": bool(facade.target),
        "target_score": float(facade.target_score),
        "mask": saved(out, f"{name}_mask", quantise.levels(facade.mask)),
        "amodal": saved(out, f"{name}_amodal", quantise.levels(facade.amodal)),
        "alpha": saved(out, f"{name}_alpha", quantise.levels(facade.alpha)),
    }
    if view is None:
        empty = ("quad", "photo_from_elevation", "focal_px", "aspect")
        nothing = dict.fromkeys([*empty, "elevation", "evidence"])
        return entry | nothing | {"vanishing_points": []}
    final = done or opened(view)
    entry |= {
        "quad": view.quad.tolist(),
        "photo_from_elevation": view.photo_from_elevation.tolist(),
        "vanishing_points": view.vanishing_points.tolist(),
        "vanishing_sd_deg": list(view.vanishing_sd_deg),
        "focal_px": view.focal_px,
        "focal_sd_px": view.focal_sd_px,
        "aspect": view.aspect,
        "aspect_sd": view.aspect_sd,
        "method": view.method,
        "rectified": saved(out, f"{name}_rectified", view.image),
        "elevation": saved(out, f"{name}_elevation", final.image),
        "inpainted": done is not None,
        "evidence": saved(out, f"{name}_evidence", final.evidence),
    }
    return finite(entry)


def opened(view: Elevation) -> Elevation:
    """Tell nothing of texels that wait for an inpainter in vain."""
    waiting = inpaint.holes(view.evidence)
    known = np.where(waiting, evidence.NOTHING, view.evidence).astype(np.uint8)
    return replace(view, evidence=known)


def finite(value: Any) -> Any:
    """Put null where a number is infinite or undefined: JSON has no word for it."""
    if isinstance(value, dict):
        return {name: finite(one) for name, one in value.items()}
    if isinstance(value, list):
        return [finite(one) for one in value]
    undefined = isinstance(value, float) and not np.isfinite(value)
    return None if undefined else value


def occluder_entries(made: Stages, photo: Photo, out: Path) -> list[dict[str, Any]]:
    """Write every occluder's mask: as matted, or as the network left it."""
    if made.matted is not None:
        found = [(one.category, one.score, one.mask) for one in made.matted.occluders]
    else:
        hidden = [one for one in made.instances if one.category != "facade"]
        found = [(one.category, one.score, whole(one, photo.image)) for one in hidden]
    return [
        {
            "category": category,
            "score": float(np.clip(score, 0, 1)),
            "mask": saved(out, f"occluder_{number}_{category}", quantise.levels(mask)),
        }
        for number, (category, score, mask) in enumerate(found)
    ]


def whole(one: Instance, image: Gray) -> np.ndarray:
    """Lay an instance's hard mask into the photo."""
    mask = np.zeros(image.shape, bool)
    x0, y0, x1, y1 = one.box
    mask[y0:y1, x0:x1] = one.probability > 0.5
    return mask


def rejection_entry(one: Rejection) -> dict[str, Any]:
    """Tell why something went no further."""
    entry = {"stage": one.stage, "reason": one.reason, "detail": one.detail}
    return entry if one.facade is None else entry | {"facade": one.facade}


def saved(out: Path, name: str, image: np.ndarray) -> str:
    """Write a picture and give its file name.

    Raises:
        OSError: if it can't be written there; OpenCV would not tell.
    """
    _, code = cv2.imencode(".png", image, [cv2.IMWRITE_PNG_COMPRESSION, 3])
    put(out / f"{name}.png", code.tobytes())
    return f"{name}.png"


def put(path: Path, data: bytes) -> None:
    """Write a file in one move; a link in its place is replaced, and never followed.

    Raises:
        OSError: if it can't be written there.
    """
    beside = path.with_name(f".{path.name}.{os.getpid()}.partial")
    beside.unlink(missing_ok=True)
    try:
        with beside.open("xb") as file:
            file.write(data)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


def pictures(made: Stages, out: Path) -> None:
    """Write what is for looking at alone: evidence in colours, lines, the panel."""
    if made.photo is None:
        return
    drawn = lines.detect(made.photo.image, lines.LOOSE)[0]
    for one in made.elevations:
        colours = draw.evidence_colours(one.evidence)
        saved(out, f"facade_{one.facade}_evidence_colours", colours)
    saved(out, "photo", made.photo.image)
    saved(out, "panel", panel(made, drawn))
