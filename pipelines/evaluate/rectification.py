"""How well fronts are straightened, part by part; one folder holds all data.

    DATA/york_urban/                            three directions of a whole photo
    DATA/taxphotos/, DATA/historic_streets/     photos/ and labels/: hand-drawn quads;
                                                and photos for the paper's table 2

The painted streets need no data. Each part is told in the module that measures it:
`york_urban`, `labelled`, `streets`, `search_space`.
"""

from pathlib import Path
from typing import Any, Final

from nostalgin_core.rectify import lines
from pipelines.evaluate import (
    Unmeasurable,
    detectors,
    label_points,
    labelled,
    pictures,
    search_space,
    sheet,
    streets,
    york_urban,
)

DETECTORS: Final[dict[str, lines.Detector]] = {
    "ours": lines.detect,
    "lsd": detectors.lsd,
    "hough": detectors.hough,
}
PARTS: Final = ("york_urban", "labels", "painted", "table2")
SETS: Final = ("taxphotos", "historic_streets")
NEEDS: Final = {
    "york_urban": "it needs york_urban/",
    "labels": "it needs taxphotos/ or historic_streets/, with photos/ and labels/",
    "table2": "it needs taxphotos/photos/ or historic_streets/photos/",
}
FRONTS: Final = 60  # painted; they are about twenty photos, so half a minute


def evaluate(
    data: Path,
    *,
    parts: tuple[str, ...] | None = None,
    detector: tuple[str, ...] = ("ours",),
    block: str = "",
    fronts: int = FRONTS,
    seed: int = streets.SEED,
    keep: Path | None = None,
    sheets: Path | None = None,
    drawn: Path | None = None,
) -> dict[str, Any]:
    """Measure the parts that are asked for, with each detector of lines.

    Args:
        data: The folder that holds the data sets.
        parts: Of `PARTS`; where none is named, all that there is data for.
        detector: Of `DETECTORS`.
        block: How the names of the labels begin.
        fronts: How many painted fronts to show.
        seed: Of the painted streets.
        keep: A folder for painted photos, which cost a CPU second each.
        sheets: A folder for the labelled photographs' contact sheets.
        drawn: A folder for their lines, and those of a painted photo, by all detectors.

    Raises:
        Unmeasurable: if a part or a detector has no such name, or a part no data.
    """
    named("part", PARTS if parts is None else parts, PARTS)
    named("detector", detector, tuple(DETECTORS))
    parts = wanted(data, parts)
    used = {name: DETECTORS[name] for name in detector}
    sets = [data / name for name in SETS if (data / name).is_dir()]
    report: dict[str, Any] = {}
    if "york_urban" in parts:
        report["york_urban"] = york_urban.evaluate(data / "york_urban", used)
    if "labels" in parts:
        report["labels"] = {
            one.name: labels(one, used, block=block, sheets=sheets)
            for one in holding(sets, block)
        }
    if "painted" in parts:
        report["painted"] = streets.evaluate(used, fronts=fronts, seed=seed, keep=keep)
    if drawn is not None:
        shown = holding(sets, block) if "labels" in parts else []
        report["lines"] = lines_drawn(shown, drawn, block, keep=keep)
    if "table2" in parts:
        folders = {one.name: one / "photos" for one in sets}
        report["table2"] = {n: search_space.evaluate(f) for n, f in folders.items()}
    return report


def wanted(data: Path, parts: tuple[str, ...] | None) -> tuple[str, ...]:
    """List the parts to measure: those named, or else all that there is data for.

    Raises:
        Unmeasurable: if there is no data for one that is named.
    """
    there = ("painted",) if parts == ("painted",) else present(data)
    for part in parts or ():
        if part not in there:
            raise Unmeasurable(f"{data} has no data for {part}: {NEEDS[part]}")
    return there if parts is None else parts


def labels(
    folder: Path,
    used: dict[str, lines.Detector],
    *,
    block: str,
    sheets: Path | None,
) -> dict[str, Any]:
    """Measure one set's labels with each detector, and draw its sheets if wanted."""
    report = {}
    for name, detector in used.items():
        photographs = list(
            labelled.straightened(folder, block=block, detector=detector)
        )
        report[name] = labelled.summed(photographs) | {
            "coverage": label_points.coverage(photographs)
        }
        if sheets is not None:
            sheet.write(photographs, sheets / folder.name / name)
    return report


def lines_drawn(
    sets: list[Path], folder: Path, block: str, *, keep: Path | None
) -> dict[str, Any]:
    """Draw the lines of all detectors on labelled photographs and on a painted one."""
    table = {}
    for one in sets:
        tables = [
            pictures.write(
                image, matted, DETECTORS, folder / one.name / f"{label['id']}.jpg"
            )
            for label, image, _, matted in labelled.photographs(one, block=block)
        ]
        table[one.name] = pictures.averaged(tables)
    (painted,) = streets.paintings(1, keep=keep)
    file = folder / "painted.jpg"
    table["painted"] = pictures.averaged(
        [pictures.write(painted.photo, painted.matted, DETECTORS, file)]
    )
    return table


def present(data: Path) -> tuple[str, ...]:
    """List the parts that a folder holds data for; painted streets need none.

    Raises:
        Unmeasurable: if there is no such folder, or it holds none of the data sets.
    """
    if not data.is_dir():
        raise Unmeasurable(
            f"{data} is no folder: name the one that holds the data sets"
        )
    york = ("york_urban",) if (data / "york_urban").is_dir() else ()
    sets = any((data / name).is_dir() for name in SETS)
    if not york and not sets:
        raise Unmeasurable(
            f"{data} holds neither york_urban/ nor {'/ nor '.join(SETS)}/: name the "
            "folder that they lie in"
        )
    return (
        *york,
        *(("labels",) if sets else ()),
        "painted",
        *(("table2",) if sets else ()),
    )


def holding(sets: list[Path], block: str) -> list[Path]:
    """Choose the folders that have a label of the block.

    Raises:
        Unmeasurable: if none has.
    """
    chosen = [one for one in sets if any((one / "labels").glob(f"{block}*.json"))]
    if not chosen:
        looked = ", ".join(str(one / "labels") for one in sets)
        raise Unmeasurable(f"no {block}*.json in {looked}: name another --block")
    return chosen


def named(what: str, wanted: tuple[str, ...], known: tuple[str, ...]) -> None:
    """Check names.

    Raises:
        Unmeasurable: if one is not known, or there is none.
    """
    unknown = [one for one in wanted if one not in known]
    if unknown or not wanted:
        asked = ", ".join(unknown) or "nothing"
        raise Unmeasurable(f"{asked}: no such {what}; there are {', '.join(known)}")
