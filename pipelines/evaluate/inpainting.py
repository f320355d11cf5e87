"""How well holes in fronts are filled: the paper's table 3, on any folder of pictures.

Every method fills the same holes. l1 and l2 in hundredths over the hidden texels whose
truth is known, mean and standard deviation over pictures, and beside them what the
paper's figures can't do without: their ratio to Navier-Stokes in the same run.
"""

import time
from pathlib import Path
from typing import Any

import numpy as np

from nostalgin_core.inpaint.inpaint import Network
from nostalgin_core.measure.inpainting import Fill, mark, methods, summary
from pipelines.evaluate import Unmeasurable
from pipelines.evaluate.inpainting_questions import HOLES, Asked, asked, kind
from pipelines.evaluate.patchmatch import SMALL_RADIUS_PX, available, patchmatch

BASELINE = "navier-stokes"


def fills(network: Network) -> dict[str, Fill]:
    """Name every method as the command line does, ours last."""
    named = {
        name.lower().replace(",", "").replace(" ", "-"): fill
        for name, fill in methods(network).items()
    }
    patches = {
        "patchmatch": patchmatch,
        "patchmatch-small": lambda image, hole: patchmatch(
            image, hole, radius=SMALL_RADIUS_PX
        ),
    }
    classical = [name for name in named if name in ("navier-stokes", "telea")]
    first = {name: named.pop(name) for name in [*classical, "biharmonic"]}
    return first | patches | named


def chosen(network: Network, wanted: str | None) -> dict[str, Fill]:
    """Pick methods by name, the baseline always among them.

    Raises:
        Unmeasurable: if there is no method of that name.
    """
    every = fills(network)
    if wanted is None:
        names = [n for n in every if available() or not n.startswith("patchmatch")]
        return {name: every[name] for name in names}
    names = {BASELINE, *(name.strip() for name in wanted.split(","))}
    if odd := sorted(names - every.keys()):
        known = ", ".join(every)
        raise Unmeasurable(f"no method {', '.join(odd)}: choose from {known}")
    return {name: fill for name, fill in every.items() if name in names}


def evaluate(
    folder: Path,
    network: Network,
    *,
    wanted: str | None = None,
    holes: tuple[str, ...] | None = None,
    most: int | None = None,
) -> dict[str, Any]:
    """Fill the holes of a folder's pictures by each method, and compare with the truth.

    Without `holes`, both kinds; on plain images, free-form ones alone.

    Raises:
        Unmeasurable: if there is nothing to measure, no such method or no such holes.
    """
    table = chosen(network, wanted)
    if holes is None:
        holes = ("free",) if kind(folder) == "plain images" else HOLES
    if odd := sorted(set(holes) - set(HOLES)):
        raise Unmeasurable(f"no holes {', '.join(odd)}: choose from {', '.join(HOLES)}")
    questions = asked(folder, holes=holes, most=most)
    return {
        "pictures": kind(folder),
        "holes": {
            one: _table(few, table)
            for one in holes
            if (few := [q for q in questions if q.holes == one])
        },
    }


def _table(questions: list[Asked], table: dict[str, Fill]) -> dict[str, Any]:
    """Score every method on the same questions."""
    rows = {name: _scores(fill, questions) for name, fill in table.items()}
    base = rows[BASELINE]
    for row in rows.values():
        for key in ("l1", "l2"):
            row[f"{key}_of_baseline"] = row[key] / base[key]
    shares = [q.question.hole.mean() for q in questions]
    return {
        "questions": len(questions),
        "hidden_share": float(np.mean(shares)),
        "methods": rows,
    }


def _scores(fill: Fill, questions: list[Asked]) -> dict[str, float]:
    """Fill every hole by one method; the truth is not shown to it."""
    marks, start = [], time.process_time()
    for one in questions:
        image, hole, _ = one.question
        shown = np.where(hole, 0, image).astype(np.uint8)
        marks.append(mark(fill(shown, hole), one.question))
    spent = time.process_time() - start
    mean, spread = summary(marks)
    return {
        "l1": mean.l1,
        "l1_sd": spread.l1,
        "l2": mean.l2,
        "l2_sd": spread.l2,
        "cpu_seconds": spent / len(questions),
    }


def text(report: dict[str, Any]) -> str:
    """Write the report as tables for people."""
    lines = []
    for holes, part in report["holes"].items():
        share = 100 * part["hidden_share"]
        title = (
            f"{report['pictures']}, {part['questions']} {NAMES[holes]}, "
            f"{share:.0f} % unknown in the mean; l1 and l2 in %, mean and sd"
        )
        lines += [
            title,
            f"{'':18}{'l1':>15}{'l2':>17}{'l1/NS':>8}{'l2/NS':>7}{'CPU s':>8}",
        ]
        for name, row in part["methods"].items():
            l1 = f"{row['l1']:.2f} ± {row['l1_sd']:.2f}"
            l2 = f"{row['l2']:.3f} ± {row['l2_sd']:.3f}"
            lines.append(
                f"{name:18}{l1:>15}{l2:>17}{row['l1_of_baseline']:8.2f}"
                f"{row['l2_of_baseline']:7.2f}{row['cpu_seconds']:8.2f}"
            )
        lines.append("")
    return "\n".join(lines)


NAMES = {"free": "free-form holes", "foot": "holes at the foot"}
