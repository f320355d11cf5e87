"""An archive's whole list, indexed and checked without one picture being read.

    python tests/bench/bench_index.py [ROWS]

Photographs are there as empty files: `index` looks at names, and `check --no-pictures`
at whether files are there. A list of a tenth of the rows tells how each grows: CPU
seconds and memory go as rows to the power of the exponent. The baseline is a loop that
only reads the list as CSV and writes it again. Wall seconds count what others do on the
machine meanwhile, CPU seconds hardly.
"""

import csv
import os
import subprocess
import sys
import tempfile
import time
from math import log10
from pathlib import Path
from typing import NamedTuple

LOTS = 60  # of a block
SMALLER = (10, 1)
COMMANDS = ("baseline", "index", "check", "asked")
BASELINE = """
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1], newline="")))
out = csv.DictWriter(open(sys.argv[2], "w", newline=""), rows[0].keys())
out.writeheader()
out.writerows(rows)
"""
ASKED = """
import sys
from pipelines.index import asked, source
from pipelines.store import Store
store = Store(sys.argv[1])
print(asked.ask(store, source.found(store), "0" * 12))
"""


class Cost(NamedTuple):
    """What a program took."""

    cpu_s: float
    wall_s: float
    most_gb: float


def write(folder: Path, rows: int) -> None:
    """Write a list in the archive's manner, and an empty file for each photograph."""
    (folder / "photos").mkdir()
    with (folder / "list.csv").open("w", newline="") as file:
        out = csv.writer(file)
        out.writerow(["photo", "block", "lot", "street", "address", "width_m", "date"])
        for n in range(rows):
            block, lot = n // LOTS + 1, n % LOTS + 1
            name = f"x_{block:05}_{lot:04}.jpg"
            (folder / "photos" / name).touch()
            street = f"{lot * 4 // (LOTS + 1)} Street {block}"
            width = 6 + n % 5
            out.writerow([name, block, lot, street, 2 * lot, width, "1939-1941"])


def measured(words: list[str]) -> Cost:
    """Run a program in a process of its own."""
    began = time.monotonic()
    command = [sys.executable, *words]
    running = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    told = running.stdout.read().decode() if running.stdout else ""
    _, status, used = os.wait4(running.pid, 0)
    running.returncode = os.waitstatus_to_exitcode(status)
    if running.returncode:
        print(words[:4], "ended with", running.returncode, told[-300:])
    wall_s = time.monotonic() - began
    return Cost(used.ru_utime + used.ru_stime, wall_s, used.ru_maxrss / 1e6)


def costs(folder: Path) -> list[Cost]:
    """Measure each command in turn."""
    listed, city = str(folder / "list.csv"), str(folder / "city")
    photos, cli = str(folder / "photos"), ["-m", "pipelines.cli"]
    return [
        measured(["-c", BASELINE, listed, str(folder / "copy.csv")]),
        measured([*cli, "index", photos, "--catalogue", listed, "-o", city, "-q"]),
        measured([*cli, "check", city, "--no-pictures"]),
        measured(["-c", ASKED, city]),
    ]


def told(rows: int, name: str, one: Cost) -> str:
    """Write a line's beginning."""
    taken = f"{one.cpu_s:7.1f} CPU s {one.wall_s:7.1f} s {one.most_gb:6.2f} GB "
    return f"{rows:>8} {name:13} {taken}"


def main(rows: int) -> None:
    """Print each command's costs, how they grow, and what they are to the baseline."""
    before: list[Cost] = []
    for smaller in SMALLER:
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), rows // smaller)
            found = costs(Path(folder))
        for place, name in enumerate(COMMANDS):
            one = found[place]
            words = f"x{one.cpu_s / found[0].cpu_s:.1f} the baseline"
            if before:
                grown = log10(one.cpu_s / before[place].cpu_s)
                words += f", CPU s as rows ^ {grown:.2f}"
                grown = log10(one.most_gb / before[place].most_gb)
                words += f", memory ^ {grown:.2f}"
            print(told(rows // smaller, name, one), words, flush=True)
        _, index, check, _ = found
        both = Cost(
            index.cpu_s + check.cpu_s,
            index.wall_s + check.wall_s,
            max(index.most_gb, check.most_gb),
        )
        print(told(rows // smaller, "index + check", both), flush=True)
        before = found


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 720_000)
