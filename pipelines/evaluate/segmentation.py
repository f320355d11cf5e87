"""How well fronts and what hides them are found: the paper's table 1 and more.

Each labelled photo goes through the shipped stages photo, segment and matte. Reported:

- precision, recall, l1 and l2 (in hundredths) of all visible front, mean and standard
  deviation over photos: the network's masks at 0.5, and mattes at an alpha of 0.1, as
  in the paper (section 4.1, appendix). A *group*, a far row that nobody can tell apart,
  counts in none of these;
- the target: its best front's overlap, visible and amodal (medians), the share found
  (overlap of a half) and the share called the target;
- the share of what hides fronts that is called an occluder, and the share of visible
  front that is, too (means over photos);
- average precision per class at overlaps of 0.5 and 0.75, of the network's things by
  their scores, before anything is arranged;
- fronts by size, angle of view and kind of error, and how far stated probabilities of
  being the target can be trusted (`segmentation_kinds`).
"""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from nostalgin_core import matte, photo, quantise
from nostalgin_core.arrays import Mask
from nostalgin_core.measure.detection import (
    Matches,
    average_precision,
    matches,
    together,
)
from nostalgin_core.measure.segmentation import Agreement, agreement, overlap
from nostalgin_core.records import Instance, Matted, Rejection
from nostalgin_core.segment import CATEGORIES, Network
from nostalgin_core.segment.segment import everything, trusted
from pipelines.evaluate import (
    Unmeasurable,
    labels,
    segmentation_kinds,
    segmentation_sheet,
)
from pipelines.evaluate.labels import Truth
from pipelines.evaluate.segmentation_kinds import Kinds

UNSURE: Final = 0.05  # average precision asks for what scores this much
FOUND: Final = 0.5  # overlap from which a front counts as found
THRESHOLD: Final = {"network": 0.5, "matted": 0.1}
OVERLAPS: Final = {"AP50": 0.5, "AP75": 0.75}


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """What the stages made of one photo."""

    shape: tuple[int, int]
    instances: tuple[Instance, ...]  # all that scored `UNSURE`
    matted: Matted
    seconds: tuple[float, float]  # CPU, for segment and matte
    rejection: str | None = None


def evaluate(
    labelled: Sequence[tuple[dict[str, Any], Path]],
    network: Network,
    *,
    sheet: Path | None = None,
) -> dict[str, Any]:
    """Measure the stages on labels and their photos, as `labels.pairs` gives them.

    Photos with errors are drawn into the folder `sheet`, a sheet a kind of error.

    Raises:
        Unmeasurable: if a file can't be read as a photo.
    """
    sorted_out: list[tuple[str, Kinds]] = []
    cells: dict[str, list[segmentation_sheet.Colour]] = {}
    rows: list[dict[str, Any]] = []
    found: dict[tuple[str, str], list[Matches]] = {
        (c, name): [] for c in CATEGORIES for name in OVERLAPS
    }
    for label, file in labelled:
        answer = answered(file, network)
        true = labels.truth(label, answer.shape)
        rows.append({"id": label["id"]} | compared(answer, true))
        told = in_kinds(answer, true)
        sorted_out.append((label["id"], told))
        if sheet is not None:
            drawn = segmentation_sheet.cells(file, label["id"], answer, true, told)
            for kind, cell in drawn.items():
                cells.setdefault(kind, []).append(cell)
        for category in CATEGORIES:
            for name, least in OVERLAPS.items():
                found[category, name].append(
                    detected(answer, true, category, least=least)
                )
    if sheet is not None:
        segmentation_sheet.write(cells, sheet)
    report = summed(rows, {key: together(parts) for key, parts in found.items()})
    return report | segmentation_kinds.summed(sorted_out)


def answered(file: Path, network: Network) -> Answer:
    """Take a photo through its stages; a refused one claims nothing.

    Raises:
        Unmeasurable: if the file can't be read as a photo.
    """
    decoded = photo.decode(file.read_bytes(), name=file.name)
    if isinstance(decoded, Rejection):
        raise Unmeasurable(f"{file}: {decoded.reason}: {decoded.detail}")
    shape = decoded.image.shape
    start = time.process_time()
    every = everything(decoded, network, least=UNSURE)
    result = trusted(decoded, every)
    segmented = time.process_time()
    things = quantise.instances(every.things)
    if not isinstance(result, Rejection):
        result = quantise.instances(result)
        before = time.process_time()
        result = matte.matte(decoded, result)
        seconds = (segmented - start, time.process_time() - before)
        if not isinstance(result, Rejection):
            return Answer(shape, things, quantise.matted(result), seconds)
    seconds = (segmented - start, 0.0)
    return Answer(shape, things, Matted((), ()), seconds, result.reason)


def compared(answer: Answer, true: Truth) -> dict[str, Any]:
    """Compare what the stages made of one photo with its label."""
    facades, shape = answer.matted.facades, answer.shape
    hiding = labels.union([one.mask for one in answer.matted.occluders], shape)
    plain = labels.union([one.mask for one in facades], shape) & ~hiding
    soft = np.max([np.zeros(shape, np.float32), *(f.alpha for f in facades)], axis=0)
    row: dict[str, Any] = {
        kind: agreement(claimed, true.visible, ~true.far, threshold=THRESHOLD[kind])
        for kind, claimed in (("network", plain.astype(np.float32)), ("matted", soft))
    }
    row["fronts"], row["target"] = fronts_found(answer.matted, true)
    covered = true.hidden & true.built
    row["occluders_found"] = share(hiding, covered) if covered.any() else None
    row["occluders_false"] = share(hiding, true.visible)
    row["seconds"] = dict(zip(("segment", "matte"), answer.seconds, strict=True))
    row["rejected"] = answer.rejection
    return row


def fronts_found(
    matted: Matted, true: Truth
) -> tuple[list[float], dict[str, Any] | None]:
    """Give each front's best overlap with one found, and what became of the target.

    What truly hides a front is taken off both. Where several fronts are the target's,
    as at a corner, the best one counts.
    """
    overlaps, target = [], None
    for front in true.fronts:
        if not front.visible.any():
            continue
        each = [overlap(f.mask & ~true.hidden, front.visible) for f in matted.facades]
        best = int(np.argmax(each)) if each else -1
        overlaps.append(max(each, default=0.0))
        if front.target and (target is None or overlaps[-1] > target["overlap"]):
            found = overlaps[-1] >= FOUND
            target = {
                "overlap": overlaps[-1],
                "amodal": overlap(matted.facades[best].amodal, front.whole)
                if found
                else 0.0,
                "called": found and bool(matted.facades[best].target),
            }
    return overlaps, target


def detected(answer: Answer, true: Truth, category: str, *, least: float) -> Matches:
    """Match the network's things of one class with the labelled ones.

    A front is what is visible of it; those of a group are left out.
    """
    found = [one for one in answer.instances if one.category == category]
    if category == "facade":
        truths = [one.visible for one in true.fronts if one.visible.any()]
        ignored = true.far
    else:
        truths = [mask for kind, mask in true.hiders if kind == category]
        ignored = np.zeros(answer.shape, bool)
    masks = [placed(one, answer.shape) for one in found]
    scores = [one.score for one in found]
    return matches(scores, masks, truths, ignored, least=least)


def in_kinds(answer: Answer, true: Truth) -> Kinds:
    """Sort one photo's fronts by size, angle and error."""
    found = [one for one in answer.instances if one.category == "facade"]
    return segmentation_kinds.kinds(
        [one.score for one in found],
        [placed(one, answer.shape) for one in found],
        answer.matted,
        true,
    )


def placed(one: Instance, shape: tuple[int, int]) -> Mask:
    """Lay what is likelier the thing than not into the photo."""
    mask = np.zeros(shape, bool)
    x0, y0, x1, y1 = one.box
    mask[y0:y1, x0:x1] = one.probability > 0.5
    return mask


def share(of: Mask, on: Mask) -> float:
    """Return the share of `on` that lies in `of`."""
    return np.count_nonzero(of & on) / max(1, np.count_nonzero(on))


def summed(
    rows: Sequence[dict[str, Any]], found: dict[tuple[str, str], Matches]
) -> dict[str, Any]:
    """Sum up the photos' figures; the photos' own are kept below `each`."""
    targets = [row["target"] for row in rows if row["target"]]
    fronts = [one >= FOUND for row in rows for one in row["fronts"]]
    hidden = [r["occluders_found"] for r in rows if r["occluders_found"] is not None]
    return {
        "photos": len(rows),
        "rejected": sum(row["rejected"] is not None for row in rows),
        "table_1": {
            kind: spread([row[kind] for row in rows]) | {"threshold": threshold}
            for kind, threshold in THRESHOLD.items()
        },
        "targets": len(targets),
        "target_overlap_median": median([one["overlap"] for one in targets]),
        "target_amodal_overlap_median": median([one["amodal"] for one in targets]),
        "target_found": mean([one["overlap"] >= FOUND for one in targets]),
        "target_called": mean([one["called"] for one in targets]),
        "fronts": len(fronts),
        "fronts_found": mean(fronts),
        "occluders_found": mean(hidden),
        "occluders_false": mean([row["occluders_false"] for row in rows]),
        "average_precision": {
            category: {
                name: number(average_precision(found[category, name]))
                for name in OVERLAPS
            }
            | {"labelled": found[category, "AP50"].truths}
            for category in CATEGORIES
        },
        "cpu_seconds_median": {
            stage: median([row["seconds"][stage] for row in rows])
            for stage in ("segment", "matte")
        },
        "each": [
            row | {kind: row[kind]._asdict() for kind in THRESHOLD} for row in rows
        ],
    }


def spread(values: Sequence[Agreement]) -> dict[str, Any]:
    """Give mean and standard deviation over photos of each of table 1's columns."""
    columns = np.array(values, float)
    return {
        name: {"mean": float(column.mean()), "sd": float(column.std())}
        for name, column in zip(Agreement._fields, columns.T, strict=True)
    }


def mean(values: Sequence[float]) -> float | None:
    """Return the mean, None of nothing."""
    return float(np.mean(values)) if len(values) else None


def median(values: Sequence[float]) -> float | None:
    """Return the median, None of nothing."""
    return float(np.median(values)) if len(values) else None


def number(value: float) -> float | None:
    """Put None where nothing was to be measured: JSON has no NaN."""
    return None if np.isnan(value) else value
