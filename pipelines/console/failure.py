"""How a command ends that went wrong: what happened, how to mend it, exit code 1."""

from pathlib import Path
from typing import Final

import typer
from rich.console import Console

FAILED: Final = 1

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
    why = problem.strerror or str(problem)
    return fail(f"{folder}: {why}; name a folder that can be written to")
