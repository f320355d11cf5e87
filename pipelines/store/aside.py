"""Elements that ended their process: no later run dies of them again.

CITY/artifacts/aside/<hash of all versions>/<key>.parquet       a rejection each
"""

import hashlib
import json
from dataclasses import dataclass, field
from typing import Any

from nostalgin_core.records import Rejection
from pipelines.store.stable import key_of
from pipelines.store.store import ARTIFACTS, Store
from pipelines.store.versions import Versions


@dataclass
class Aside:
    """Which elements ended their process, as the store remembers them."""

    store: Store
    versions: Versions  # of all stages: others may do better
    retry: bool = False  # as if there were none
    _known: set[str] | None = field(default=None, init=False, compare=False)

    def __getstate__(self) -> dict[str, Any]:
        """Let every process look for itself."""
        return self.__dict__ | {"_known": None}

    def of(self, stage: str, element: Any) -> Rejection | None:
        """Tell why an element was put aside, if it was."""
        name = self._name(stage, element)
        if self.retry or name not in self._listed():
            return None
        verdict = self.store.verdict(f"{self._folder()}/{name}")
        return verdict if isinstance(verdict, Rejection) else None

    def put(self, stage: str, element: Any, why: Rejection) -> None:
        """Remember an element."""
        self.store.keep(f"{self._folder()}/{self._name(stage, element)}", why)

    def forget(self, stage: str, element: Any) -> None:
        """Let an element be as others: it was tried again, and came through."""
        name = self._name(stage, element)
        if self.retry and name in self._listed():
            self.store.drop(f"{self._folder()}/{name}")
            self._listed().discard(name)

    def _listed(self) -> set[str]:
        if self._known is None:
            self._known = set(self._names())
        return self._known

    def _names(self) -> list[str]:
        try:
            return self.store.names(self._folder())
        except OSError:  # where nothing can be kept, the stage itself will tell
            return []

    def _folder(self) -> str:
        return f"{ARTIFACTS}/aside/{key_of(json.dumps(vars(self.versions)))[:16]}"

    def _name(self, stage: str, element: Any) -> str:
        told = hashlib.sha256(spelt(element).encode(errors="surrogateescape"))
        return f"{key_of(stage, told.hexdigest())}.parquet"


def spelt(element: Any) -> str:
    """Write an element as text; of a group, as no order of arrival changes it."""
    key, groups = element if isinstance(element, tuple) else (element, {})
    told = {name: sorted(map(repr, groups[name])) for name in sorted(groups)}
    return repr((key, told))
