"""An archive's whole list, indexed and checked without one picture being read.

    python tests/bench/bench_index.py [ROWS]

Photographs are there as empty files: `index` looks at names, and `check --no-pictures`
at whether files are there. Two lists of a tenth and a hundredth of the rows tell how
each grows: CPU seconds and memory go as rows to the power of the exponent. The baseline
is a loop that only reads the list as CSV and writes it again.
"""

import csv
import os
import subprocess
import sys
import tempfile
from math import log10
from pathlib import Path

LOTS = 60  # of a block
SMALLER = (100, 10, 1)
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

Cost = tuple[float, float]  # CPU seconds, and the most memory in GB


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
    command = [sys.executable, *words]
    running = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    told = running.stdout.read().decode() if running.stdout else ""
    _, status, used = os.wait4(running.pid, 0)
    running.returncode = os.waitstatus_to_exitcode(status)
    if running.returncode:
        print(words[:4], "ended with", running.returncode, told[-300:])
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1e6


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


def main(rows: int) -> None:
    """Print each command's costs, how they grow, and what they are to the baseline."""
    before: list[Cost] = []
    for smaller in SMALLER:
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), rows // smaller)
            found = costs(Path(folder))
        for place, name in enumerate(COMMANDS):
            cpu_s, most_gb = found[place]
            ratio = cpu_s / found[0][0]
            grown = f"  x{ratio:.1f} the baseline"
            if before:
                grown += f", CPU s as rows ^ {log10(cpu_s / before[place][0]):.2f}"
                grown += f", memory ^ {log10(most_gb / before[place][1]):.2f}"
            print(
                f"{rows // smaller:>8} {name:9} {cpu_s:7.1f} CPU s {most_gb:6.2f} GB",
                grown,
                flush=True,
            )
        before = found


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 720_000)
