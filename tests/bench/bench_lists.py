"""An archive's whole list, indexed and checked without one picture being read.

    python tests/bench/bench_lists.py ROWS

Against the same list of a tenth of the rows, so that what grows faster shows.
"""

import csv
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

LOTS = 60  # of a block


def write(folder: Path, rows: int) -> None:
    """Write a list in the archive's manner; one photograph stands for all."""
    (folder / "photos").mkdir()
    (folder / "photos" / "x_00001_0001.jpg").write_bytes(b"x")
    with (folder / "list.csv").open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["photo", "block", "lot", "street", "address", "width_m", "date"])
        for n in range(rows):
            block, lot = n // LOTS + 1, n % LOTS + 1
            name = f"x_{block:05}_{lot:04}.jpg"
            street = f"{lot * 4 // (LOTS + 1)} Street {block}"
            width = 6 + n % 5
            out.writerow([name, block, lot, street, 2 * lot, width, "1939-1941"])


def measured(folder: Path) -> tuple[float, float]:
    """Index and check; give CPU seconds, and the most memory of either in GB."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    city = str(folder / "city")
    words = ["index", str(folder / "photos"), "--catalogue", str(folder / "list.csv")]
    for command in ([*words, "-o", city], ["check", city, "--no-pictures"]):
        began = time.monotonic()
        done = subprocess.run(
            [sys.executable, "-m", "pipelines.cli", *command],
            capture_output=True,
            text=True,
            check=False,
        )
        print(command[0], done.returncode, f"{time.monotonic() - began:.0f} s")
        print(done.stderr[-300:])
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime, after.ru_maxrss / 1e6


def main(rows: int) -> None:
    """Print both, and their ratio."""
    seconds = []
    for count in (rows // 10, rows):
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), count)
            cpu_s, most_gb = measured(Path(folder))
        seconds.append(cpu_s)
        print(f"{count} rows: {cpu_s:.0f} CPU s, {most_gb:.2f} GB at most")
    print(f"ten times the rows take {seconds[1] / seconds[0]:.1f} times as long")


if __name__ == "__main__":
    main(int(sys.argv[1]))
