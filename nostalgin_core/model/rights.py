"""Whose photographs a model shows, and what may be done with it: told in every file."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

UNSTATED: Final = "not stated"


@dataclass(frozen=True, slots=True)
class Rights:
    """Whom to name, under which licence, and where the photographs are kept."""

    credit: str = ""
    licence: str = ""  # its name, or its address
    sources: tuple[str, ...] = ()  # addresses of the archive's records
    # What is told of each photograph that is worn, by key: rights, licence, date...
    photographs: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    watermarks: tuple[str, ...] = ()  # what those said that were taken out of textures

    @property
    def line(self) -> str:
        """Say it in one line, for glTF's `asset.copyright`; what nobody stated, too."""
        lead = "" if self.credit else "credit "
        return f"{lead}{self.whose}; licence: {self._licence}"

    @property
    def whose(self) -> str:
        """Say whom to name: what a watermark said that was taken out is said here."""
        marks = (f"{words} (a watermark taken out)" for words in self.watermarks)
        return "; ".join([self.credit or UNSTATED, *marks])

    @property
    def extras(self) -> dict[str, Any]:
        """Say it as values; few programs show the line."""
        return {
            "credit": self.whose,
            "licence": self._licence,
            "sources": list(self.sources),
            **({"photographs": self.photographs} if self.photographs else {}),
        }

    @property
    def _licence(self) -> str:
        return self.licence or UNSTATED
