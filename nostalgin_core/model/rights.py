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

    @property
    def line(self) -> str:
        """Say it in one line, for glTF's `asset.copyright`; what nobody stated, too."""
        return f"{self.credit or f'credit {UNSTATED}'}; licence: {self._licence}"

    @property
    def extras(self) -> dict[str, Any]:
        """Say it as values; few programs show the line."""
        return {
            "credit": self.credit or UNSTATED,
            "licence": self._licence,
            "sources": list(self.sources),
            **({"photographs": self.photographs} if self.photographs else {}),
        }

    @property
    def _licence(self) -> str:
        return self.licence or UNSTATED
