"""How a command ends that went wrong: what happened, how to mend it, exit code 1."""

import contextlib
import errno
import os
import sys
from pathlib import Path
from typing import Any, Final

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
    with contextlib.suppress(OSError):  # nobody hears it; the exit code tells
        errors.print("[bold red]error:[/] ", end="")
        errors.print(harmless(message), markup=False)
    return typer.Exit(FAILED)


def echo(text: str) -> None:
    """Tell on standard output what came of a command that has written its files.

    Raises:
        Exit: if nobody can read it there.
    """
    try:
        print(harmless(text), flush=True)  # noqa: T201
    except OSError as problem:
        why = unheard(sys.stdout, problem)
        raise fail(f"standard output: {why}; the files are written") from problem


def unheard(stream: Any, problem: BaseException) -> str:
    """Let a stream that takes no more lead nowhere, and tell why it takes none."""
    with contextlib.suppress(OSError, ValueError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
    return getattr(problem, "strerror", "") or "Broken pipe"


def opened_streams() -> None:
    """Open the standard streams that are closed, so that no file takes their place.

    Libraries write to the second of them, whatever it is.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the least number that is free
            mode = "w" if number else "r"
            setattr(sys, name, os.fdopen(number, mode, closefd=False))


def unwritable(folder: str | Path, problem: OSError) -> typer.Exit:
    """Say that results could not be put where they were wanted."""
    if problem.errno in REMEDIES:  # Arrow tells the same in more words
        why, remedy = os.strerror(problem.errno), REMEDIES[problem.errno]
    else:
        why = problem.strerror or str(problem)
        remedy = "name a folder that can be written to"
    return fail(f"{folder}: {why}; {remedy}")


def unreadable(city: str | Path, problem: OSError) -> typer.Exit:
    """Say that a city folder could not be read, and the remedy if words lack one."""
    why = problem.strerror or str(problem)
    told = problem.errno == errno.EIO  # by whoever raised it
    return fail(f"{city}: {why}" if told else f"{city}: {why}; name a city folder")
