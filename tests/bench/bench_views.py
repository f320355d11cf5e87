"""Print what neighbours' views cost beside the rest of a build: CPU seconds a photo.

    python tests/bench/bench_views.py [PHOTOS CATALOGUE]

A block is painted (or the photos of a folder are taken), indexed and built by one
worker. `assign` compares facades of different photos and places the block, `borrow`
fills fronts from other photos; the baseline is what the same run spends on the rest.
The aim is 0.6 CPU seconds a photo.
"""

import json
import sys
import tempfile
from pathlib import Path

from rich.console import Console

from pipelines.build import build, options
from pipelines.console.hush import hushed
from pipelines.demo import painted
from pipelines.index.index import index
from pipelines.models import one_thread
from pipelines.store.runs import CURRENT

VIEWS = ("assign", "borrow")


def spent(city: Path) -> dict[str, float]:
    """Read what each stage of the run that a city shows took, in CPU seconds."""
    run = (city / CURRENT).read_text().strip()
    told = json.loads((city / "runs" / run / "run.json").read_text())["stages"]
    return {name: one.get("cpu_milliseconds", 0) / 1e3 for name, one in told.items()}


def main(photos: Path | None, listed: Path | None) -> None:
    """Build a city, and print what its stages took."""
    one_thread()
    with tempfile.TemporaryDirectory() as folder:
        city = Path(folder)
        if photos is None or listed is None:
            photos, listed = painted(city, blocks=1, tell=lambda *_: None)
        index(photos, listed, folder)
        with hushed(Console(stderr=True)):
            build(options(folder, beam=["--direct_num_workers=1"]))
        count = sum(1 for path in photos.iterdir() if path.is_file())
        took = spent(city)
    for name, seconds in sorted(took.items(), key=lambda one: -one[1]):
        print(f"{name:10} {seconds:7.1f} CPU s, {seconds / count:.2f} a photo")
    views = sum(took.get(name, 0.0) for name in VIEWS)
    rest = sum(took.values()) - views
    print(
        f"views      {views / count:.2f} CPU s a photo, {views / rest:.2f} of the rest"
    )


if __name__ == "__main__":
    named = [Path(word) for word in sys.argv[1:3]]
    main(*(named if len(named) == 2 else [None, None]))
