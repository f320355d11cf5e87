"""The run whose city is shown, as its own files tell it."""

import contextlib
import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Final

import pyarrow as pa

from pipelines.build import DIRECTED
from pipelines.index.asked import ASKED
from pipelines.store import Store, runs
from pipelines.store.refuse import record
from pipelines.store.versions import Versions

GIGA: Final = 1_000_000_000


@dataclass(frozen=True)
class Published:
    """A run, and what it was asked for; without a name there is none."""

    store: Store
    run: str = ""
    told: dict[str, Any] = field(default_factory=dict)  # its run.json

    @property
    def rows_sha256(self) -> str:
        """Hash what its rows followed from; "" if it does not tell."""
        return str(self.told.get("rows", ""))

    @property
    def versions(self) -> Versions | None:
        """Name the versions that it was made with, if it tells."""
        with contextlib.suppress(KeyError, TypeError):
            return Versions(**self.told["versions"])
        return None

    @property
    def began_ns(self) -> int:
        """Tell when it began; 0 if it does not."""
        with contextlib.suppress(ValueError):
            began = datetime.fromisoformat(str(self.told.get("began", "")))
            return int(began.timestamp()) * GIGA
        return 0

    def asked(self) -> Iterator[pa.Table]:
        """Read the rows that it was asked for, in groups."""
        if self.run:
            yield from self.store.read_groups(runs.table_path(self.run, ASKED))

    def parts(self, name: str, *columns: str) -> Iterator[pa.Table]:
        """Read columns of one of its tables part by part; of one without it, none."""
        if self.run:
            with contextlib.suppress(FileNotFoundError):
                yield from runs.each_part(self.store, self.run, name, columns)

    def directed(self) -> dict[str, dict[str, float]]:
        """Read which heights and facades it was told of."""
        with contextlib.suppress(OSError, ValueError):
            told = self.store.read_bytes(f"runs/{self.run}/{DIRECTED}")
            return json.loads(told)
        return {}


def published(store: Store) -> Published:
    """Find the run whose city is shown."""
    try:
        run = runs.shown(store)
    except FileNotFoundError:
        return Published(store)
    return Published(store, run, record(store, run))
