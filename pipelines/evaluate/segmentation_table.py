"""The report of `segmentation` as tables for people."""

from typing import Any

FIGURES = {
    "fronts": "fronts",
    "fronts_found": "fronts found (overlap of 0.5)",
    "targets": "target fronts",
    "target_overlap_median": "target's overlap, median",
    "target_amodal_overlap_median": "target's overlap with what is hidden, median",
    "target_found": "targets found",
    "target_called": "targets called the target",
    "occluders_found": "hidden front called occluder",
    "occluders_false": "visible front called occluder",
}

NAMED = 6  # photos in a line
ERRORS = {
    "merged": "taken for one with another front",
    "split": "cut up",
    "missed": "missed",
    "walled": "lost in a wall, sky or street",
    "wall": "claimed where no front is",
}


def text(report: dict[str, Any]) -> str:
    """Write the report as tables."""
    seconds = report["cpu_seconds_median"]
    told = [(words, said(report[name])) for name, words in FIGURES.items()]
    told += [
        (f"CPU seconds a photo, {stage}, median", said(spent))
        for stage, spent in seconds.items()
    ]
    return "\n".join(
        [
            f"{report['photos']} photos, {report['rejected']} rejected",
            "",
            *table_1(report["table_1"]),
            "",
            *(f"{words:<46}{value:>8}" for words, value in told),
            "",
            *precisions(report["average_precision"]),
            "",
            *by_kind("visible share of the photo", report["facades_by_size"]),
            "",
            *by_kind("degrees from straight on", report["facades_by_angle_deg"]),
            "",
            *errors(report["errors"]),
            "",
            *calibration(report["target_probability"]),
        ]
    )


def table_1(rows: dict[str, dict[str, Any]]) -> list[str]:
    """Write the paper's table 1: all in hundredths, mean and standard deviation."""
    hundredths = {"precision": 100, "recall": 100, "l1": 1, "l2": 1}
    heads = [f"{name:>14}" for name in hundredths]
    lines = ["".join(["visible front   ", *heads])]
    for kind, row in rows.items():
        cells = [
            f"{row[name]['mean'] * scale:.1f} +- {row[name]['sd'] * scale:.1f}"
            for name, scale in hundredths.items()
        ]
        name = f"{kind} > {row['threshold']}"
        lines.append(f"{name:<16}" + "".join(f"{cell:>14}" for cell in cells))
    return lines


def precisions(rows: dict[str, dict[str, Any]]) -> list[str]:
    """Write the average precision of each class."""
    lines = [f"{'class':<12}{'labelled':>10}{'AP50':>8}{'AP75':>8}"]
    for category, row in rows.items():
        cells = "".join(f"{said(row[name]):>8}" for name in ("AP50", "AP75"))
        lines.append(f"{category:<12}{row['labelled']:>10}{cells}")
    return lines


def by_kind(head: str, rows: dict[str, dict[str, Any]]) -> list[str]:
    """Write the average precision of fronts of each size, or angle."""
    lines = [f"{head:<28}{'labelled':>10}{'AP50':>8}"]
    return lines + [
        f"{name:<28}{row['labelled']:>10}{said(row['AP50']):>8}"
        for name, row in rows.items()
    ]


def errors(told: dict[str, Any]) -> list[str]:
    """Write how many fronts went wrong in which way, and in which photos."""
    lines = [f"of {told['fronts']} labelled fronts, and {told['claimed']} claimed"]
    for kind, words in ERRORS.items():
        row = told[kind]
        photos = row["photos"]
        named = ", ".join(photos[:NAMED]) + (", ..." if len(photos) > NAMED else "")
        lines.append(f"{words:<40}{row['count']:>5}  {named}".rstrip())
    return lines


def calibration(told: dict[str, Any]) -> list[str]:
    """Write how often what was stated of being the target came true."""
    lines = [
        f"a target was called in {told['called']} of {told['photos']} photos,",
        f"rightly in {told['called_rightly']}; the likeliest was right in "
        + str(told["first_right"]),
        "stated probability: Brier score, calibration error "
        + ", ".join(said(told[name]) for name in ("brier", "error")),
        f"{'stated':<14}{'fronts':>8}{'mean':>8}{'true':>8}",
    ]
    return lines + [
        f"{row['low']:.1f} to {row['high']:.1f}".ljust(14)
        + f"{row['count']:>8}{row['stated']:>8.3f}{row['share']:>8.3f}"
        for row in told["bins"]
    ]


def said(value: float | None) -> str:
    """Write a share with three places, a count as it is, nothing as a dash."""
    if value is None:
        return "-"
    return str(value) if isinstance(value, int) else f"{value:.3f}"
