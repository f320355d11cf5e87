"""A city's title: one line that can be shown anywhere, whatever was written."""

from typing import Final

LONGEST: Final = 100  # letters: two lines in the viewer's corner
JOINERS: Final = "\u200c\u200d"  # no letters, but some scripts are misread without them


def cleaned(written: str) -> str:
    """Write a title in one line of letters that can be seen, and not too many of them.

    Line breaks, control characters and marks that turn the direction of writing count
    as spaces. What is said twice says the same as once: it is a projection.
    """
    seen = "".join(
        letter if letter.isprintable() or letter in JOINERS else " "
        for letter in written[: 100 * LONGEST]
    )
    line = " ".join(seen.split())
    return line if len(line) <= LONGEST else line[: LONGEST - 1].rstrip() + "\u2026"


def of_folder(name: str) -> str:
    """Make a title of a folder's name: demo-city is "Demo city"."""
    words = cleaned(name.replace("-", " ").replace("_", " "))
    return words[:1].upper() + words[1:] or "A city"
