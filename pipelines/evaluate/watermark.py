"""What is left of a known watermark in copies that it was not measured on.

The copies are halved, each half's mark is measured on the other, and taken out as a
build does. A mark's strength is what `rectify.watermark.fit` gives: 1 of a copy with
the known mark, 0 without.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import median
from typing import Any, Final

from nostalgin_core import photo
from nostalgin_core.arrays import Gray
from nostalgin_core.measure import watermarks
from nostalgin_core.records import Photo
from nostalgin_core.rectify import Watermark, unmarked
from nostalgin_core.rectify.watermark import WIDE_PX, fit
from pipelines.evaluate import Unmeasurable
from pipelines.index import watermarks as archives

SUFFIXES: Final = {".jpg", ".jpeg", ".png", ".tif", ".tiff"}
LEAST: Final = 4  # copies, to be halved


def evaluate(
    folder: Path, *, name: str, without: Path | None = None, write: Path | None = None
) -> dict[str, Any]:
    """Measure and take out a mark, each half of a folder by the other half's.

    Raises:
        Unmeasurable: if the mark is not known, or the photographs are too few.
    """
    known = archives.known()
    if name not in known:
        raise Unmeasurable(f"{name}: no known watermark; one of {', '.join(known)}")
    shipped = archives.watermark(name)
    files = pictures(folder)
    if shipped is None or len(files) < LEAST:
        raise Unmeasurable(f"{folder}: {len(files)} photographs, of {LEAST} or more")
    halves = files[0::2], files[1::2]
    rows = [
        row
        for own, other in (halves, halves[::-1])
        for row in taken_out(own, measured(other, shipped))
    ]
    others = [] if without is None else list(taken_out(pictures(without), shipped))
    if write is not None:
        write.write_bytes(archives.written(measured(files, shipped)))
    return summed(rows, others) | {"photos": rows}


def pictures(folder: Path) -> list[Path]:
    """List the photographs of a folder, as they are named."""
    return sorted(one for one in folder.glob("*") if one.suffix.lower() in SUFFIXES)


def read(files: Sequence[Path]) -> Iterator[Photo]:
    """Read photographs, one at a time; those that can't be read are left out."""
    for file in files:
        decoded = photo.decode(file.read_bytes(), name=file.name)
        if isinstance(decoded, Photo):
            yield decoded


def measured(files: Sequence[Path], known: Watermark) -> Watermark:
    """Measure a mark's tile on copies no wider than it is looked for in."""

    def images() -> Iterator[Gray]:
        return (one.image for one in read(files) if one.image.shape[1] <= WIDE_PX)

    return watermarks.measured(images, known)


def taken_out(files: Sequence[Path], mark: Watermark) -> Iterator[dict[str, Any]]:
    """Take a mark out of photographs, and tell how strong it was and is."""
    for one in read(files):
        before = fit(one.image, mark)
        clear, words = unmarked(one, mark)
        row = {"key": one.key, "found": bool(words), "same": clear is one}
        row |= {"strength": before.strength, "surely": before.surely}
        yield row | {"left": fit(clear.image, mark).strength}


def summed(
    rows: Sequence[dict[str, Any]], others: Sequence[dict[str, Any]]
) -> dict[str, Any]:
    """Sum up how much was found and is left, and the surest of those without it."""
    shares = [abs(row["left"]) / row["strength"] for row in rows if row["found"]]
    return {
        "copies": len(rows),
        "found": sum(row["found"] for row in rows),
        "least_surely": min(row["surely"] for row in rows),
        "median_strength": median(row["strength"] for row in rows),
        "median_left": median(abs(row["left"]) for row in rows),
        "below_a_fifth": sum(share < 0.2 for share in shares),
        "worst_share_left": max(shares, default=0.0),
        "others": len(others),
        "others_found": sum(row["found"] for row in others),
        "others_most_surely": max((row["surely"] for row in others), default=0.0),
    }


def text(report: dict[str, Any]) -> str:
    """Write the figures for people."""
    one = report
    surely, strength = one["least_surely"], one["median_strength"]
    left = one["median_left"]
    few, worst = one["below_a_fifth"], one["worst_share_left"]
    found = f"found in {one['found']} of {one['copies']} copies"
    lines = [
        f"{found}, the least sure by {surely:.0f} standard deviations",
        f"strength {strength:.2f} in the median, {left:.3f} once taken out",
        f"less than a fifth is left in {few}, the worst keeps {worst:.0%}",
    ]
    if one["others"]:
        found = f"found in {one['others_found']} of {one['others']} others"
        surely = one["others_most_surely"]
        lines.append(f"{found}, the surest by {surely:.1f} standard deviations")
    return "\n".join(lines) + "\n"
