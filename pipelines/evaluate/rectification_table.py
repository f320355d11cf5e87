"""The report of `rectification` as tables for people."""

from typing import Any, Final

YORK: Final = {
    "median": ("median_deg", "deg"),
    "mean": ("mean_deg", "deg"),
    "horizon": ("horizon_auc", "AUC"),
    "focal": ("focal_error_percent", "%"),
    "time": ("cpu_seconds_median", "CPU s"),
}
LABELS: Final = ("target", "all")
PAINTED: Final = {
    "corners": ("corners_px", "px"),
    "corners of width": ("corners_percent", "%"),
    "aspect": ("aspect_percent", "%"),
    "worst angle": ("worst_deg", "deg"),
}
PAPER: Final = {
    "collinear lines": "41.0 +- 16.1  33.1 +- 29.8",
    "infinite points": "11.4 +- 19.1  10.1 +- 7.5",
    "both": "44.3 +- 18.7  35.6 +- 37.7",
}
LINES: Final = ("lines", "median_px", "up_lines", "level_lines", "silent_percent")
UNITS: Final = {"horizontal": "deg", "vertical": "deg", "focal": "%", "aspect": "%"}

Report = dict[str, Any]


def text(report: Report) -> str:
    """Write the report as tables."""
    writers = {
        "york_urban": york_urban,
        "labels": labels,
        "painted": painted,
        "lines": line_methods,
        "table2": table_2,
    }
    lines: list[str] = []
    for name, write in writers.items():
        if name in report:
            lines += [*write(report[name]), ""]
    return "\n".join(lines).rstrip()


def york_urban(rows: Report) -> list[str]:
    """Write errors of vanishing points, a finder a row."""
    images = next(iter(rows.values()))["images"]
    heads = [f"{head} {unit}" for head, (_, unit) in YORK.items()]
    lines = [
        f"York Urban, {images} images, no mask and no camera given",
        _row("", heads),
    ]
    for name, row in rows.items():
        if isinstance(row, str):
            lines.append(f"{name}: {row}")
        else:
            lines.append(_row(name, [said(row[key]) for key, _ in YORK.values()]))
    return lines


def labels(sets: Report) -> list[str]:
    """Write worst angles of labelled quads, a set, detector and kind of front a row."""
    heads = ["fronts", "straightened", "median deg", "90 % deg", "CPU s a photo"]
    lines = [
        "Labelled quads, worst angle once straightened, labels as masks",
        _row("", heads),
    ]
    for name, finders in sets.items():
        for finder, row in finders.items():
            for kind in LABELS:
                cells = [
                    str(row[f"{kind}_fronts"]),
                    str(row[f"{kind}_straightened"]),
                    said(row[f"{kind}_angle_median"]),
                    said(row[f"{kind}_angle_p90"]),
                    said(row["cpu_seconds_median"]),
                ]
                lines.append(_row(f"{name}, {finder}, {kind}", cells))
            lines.append(_rejections(row["rejections"]))
            lines += coverage(row["coverage"], "stated 95 % and labels' 2 px")
    return lines


def painted(finders: Report) -> list[str]:
    """Write how near quads are on painted streets, and whether intervals hold."""
    lines: list[str] = []
    for finder, row in finders.items():
        lines.append(
            f"Painted streets, {finder}: {row['photographs']} photos, {row['fronts']} "
            f"fronts, {row['straightened']} of {row['complete_fronts']} wholly in the "
            "frame straightened"
        )
        lines.append(_row("", ["median", "90 %"]))
        for name, (key, unit) in PAINTED.items():
            cells = [said(row[f"{key}_median"]), said(row[f"{key}_p90"])]
            lines.append(_row(f"{name}, {unit}", cells))
        lines += [_rejections(row["rejections"]), *coverage(row["coverage"]), ""]
    return lines[:-1]


def coverage(table: Report, title: str = "stated 95 % intervals") -> list[str]:
    """Write how often stated 95 % intervals hold the truth."""
    heads = ["n", "covered %", "Wilson 95 %", "width", "|error| / sd at 50 68 90 95 %"]
    lines = [_row(title, heads)]
    for quantity, rows in table.items():
        for method, row in rows.items():
            cells = [
                str(row["count"]),
                f"{100 * row['share']:.1f}",
                f"{100 * row['low']:.1f} - {100 * row['high']:.1f}",
                f"{row['median_width']:.2f} {UNITS[quantity]}",
                "  ".join(f"{one:.2f}" for one in row["residuals"]),
            ]
            lines.append(_row(f"{quantity}, {method}", cells))
    return lines


def line_methods(sets: Report) -> list[str]:
    """Write how many lines each method lets speak, and how many vote for nothing."""
    heads = ["photos", "lines", "median px", "up", "level", "silent %"]
    lines = ["Lines on fronts, means over photos", _row("", heads)]
    for name, methods in sets.items():
        for method, row in methods.items():
            cells = [str(row["photographs"]), *(said(row[key]) for key in LINES)]
            lines.append(_row(f"{name}, {method}", cells))
    return lines


def table_2(sets: Report) -> list[str]:
    """Write the paper's table 2: by how much candidates and time shrink."""
    heads = [
        "space %",
        "CPU time %",
        "winner moves deg",
        "refined",
        "paper: space, time",
    ]
    lines = ["Table 2, photos of 2048 px on the short side, without doubles of"]
    for name, rows in sets.items():
        lines.append(_row(f"{name}, {rows['photographs']} photos", heads))
        for kind, paper in PAPER.items():
            row = rows[kind]
            cells = [
                f"{row[f'{what}_percent_mean']:.1f} +- {row[f'{what}_percent_sd']:.1f}"
                for what in ("space", "time")
            ]
            cells += [
                f"{row[f'{what}_median']:.2f}, at most {row[f'{what}_max']:.2f}"
                for what in ("moved_deg", "refined_moved_deg")
            ]
            lines.append(_row(kind, [*cells, paper]))
    return lines


def said(value: float | None) -> str:
    """Write a figure, or that there is none."""
    return "-" if value is None else f"{value:.2f}"


def _rejections(reasons: Report) -> str:
    """Write why fronts were not straightened."""
    told = ", ".join(f"{count} {reason}" for reason, count in reasons.items())
    return f"  not straightened: {told or 'none'}"


def _row(name: str, cells: list[str]) -> str:
    """Align a row; a long cell takes what it needs."""
    return f"{name:<40}" + "".join(f"  {cell:>13}" for cell in cells)
