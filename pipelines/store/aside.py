"""Elements that ended their process: no later run dies of them again.

CITY/artifacts/aside/<hash of all versions>/<key>.parquet       a rejection each
"""

import hashlib
import json
from dataclasses import dataclass, field
from typing import Any

from nostalgin_core.records import Rejection
from pipelines.store.store import ARTIFACTS, Store, key_of
from pipelines.store.versions import Versions


@dataclass
class Aside:
    """Which elements ended their process, as the store remembers them."""

    store: Store
    versions: Versions  # of all stages: others may do better
    retry: bool = False  # as if there were none
    _known: frozenset[str] | None = field(default=None, init=False, compare=False)

    def __getstate__(self) -> dict[str, Any]:
        """Let every process look for itself."""
        return self.__dict__ | {"_known": None}

    def of(self, stage: str, element: Any) -> Rejection | None:
        """Tell why an element was put aside, if it was."""
        if self._known is None:
            self._known = frozenset(() if self.retry else self._names())
        name = f"{self._key(stage, element)}.parquet"
        if name not in self._known:
            return None
        verdict = self.store.verdict(f"{self._folder()}/{name}")
        return verdict if isinstance(verdict, Rejection) else None

    def put(self, stage: str, element: Any, why: Rejection) -> None:
        """Remember an element."""
        name = f"{self._key(stage, element)}.parquet"
        self.store.keep(f"{self._folder()}/{name}", why)

    def _names(self) -> list[str]:
        try:
            return self.store.names(self._folder())
        except OSError:  # where nothing can be kept, the stage itself will tell
            return []

    def _folder(self) -> str:
        return f"{ARTIFACTS}/aside/{key_of(json.dumps(vars(self.versions)))[:16]}"

    def _key(self, stage: str, element: Any) -> str:
        told = hashlib.sha256(spelt(element).encode(errors="surrogateescape"))
        return key_of(stage, told.hexdigest())


def spelt(element: Any) -> str:
    """Write an element as text; of a group, as no order of arrival changes it."""
    key, groups = element if isinstance(element, tuple) else (element, {})
    told = {name: sorted(map(repr, groups[name])) for name in sorted(groups)}
    return repr((key, told))
