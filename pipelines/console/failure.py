"""How a command ends that went wrong: what happened, how to mend it, exit code 1."""

import errno
import os
from pathlib import Path
from typing import Final

import typer
from rich.console import Console

FAILED: Final = 1
REMEDIES: Final = {
    errno.ENOSPC: "make room, or name a folder on another disk",
    errno.EDQUOT: "make room, or name a folder on another disk",
    errno.EFBIG: "allow larger files (ulimit -f), or name a folder on another disk",
}

errors = Console(stderr=True, highlight=False, soft_wrap=True)


def harmless(text: str) -> str:
    """Spell out letters that a terminal would obey: a file's name may hold any."""
    return "".join(
        letter if letter.isprintable() else ascii(letter)[1:-1] for letter in text
    )


def fail(message: str) -> typer.Exit:
    """Say on standard error what went wrong and how to mend it."""
    errors.print("[bold red]error:[/] ", end="")
    errors.print(harmless(message), markup=False)
    return typer.Exit(FAILED)


def unwritable(folder: str | Path, problem: OSError) -> typer.Exit:
    """Say that results could not be put where they were wanted."""
    if problem.errno in REMEDIES:  # Arrow tells the same in more words
        why, remedy = os.strerror(problem.errno), REMEDIES[problem.errno]
    else:
        why = problem.strerror or str(problem)
        remedy = "name a folder that can be written to"
    return fail(f"{folder}: {why}; {remedy}")
