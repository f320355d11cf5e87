"""The small pictures of a run's photographs, known by 64 bytes each."""

from collections.abc import Iterator, Mapping
from collections.abc import Set as AbstractSet
from typing import Final

import numpy as np

from pipelines.site.naming import safe
from pipelines.store import Store, runs
from pipelines.store.versions import Versions

KEY: Final = 16  # letters of a photo's hash that are its key


class Thumbnails(Mapping[str, bytes]):
    """The small pictures of all photos that could be read, by key, read one by one."""

    def __init__(
        self,
        store: Store,
        run: str,
        versions: Versions,
        standing: AbstractSet[str] = frozenset(),
    ) -> None:
        """Find out which there are; what is `standing` in the site, is there."""
        self._store, self._versions = store, versions
        every = hashes(store, run)
        there = [
            f"photos/{safe(one[:KEY])}.webp" in standing
            or store.verdict(path_of(versions, one)) is True
            for one in map(bytes.decode, every)
        ]
        self._hashes = every[np.array(there, bool)]

    def __getitem__(self, key: str) -> bytes:
        """Read one."""
        told = self._find(key)
        if not told:
            raise KeyError(key)
        table = self._store.read_table(path_of(self._versions, told), ["picture"])
        return table.column("picture")[0].as_py()

    def __contains__(self, key: object) -> bool:
        """Tell whether there is one, unread."""
        return bool(self._find(str(key)))

    def __iter__(self) -> Iterator[str]:
        """Name all."""
        return (bytes(one[:KEY]).decode() for one in self._hashes)

    def __len__(self) -> int:
        """Count them."""
        return len(self._hashes)

    def _find(self, key: str) -> str:
        at = int(np.searchsorted(self._hashes, key.encode(errors="replace")))
        told = bytes(self._hashes[at]).decode() if at < len(self._hashes) else ""
        return told if key and told[:KEY] == key else ""


def hashes(store: Store, run: str) -> np.ndarray:
    """Give the SHA-256 of each photo of a run once, sorted."""
    parts = runs.each_part(store, run, "photos", ["sha256"])
    own = [np.array(part.column("sha256").to_pylist(), "S64") for part in parts]
    return np.unique(np.concatenate([*own, np.zeros(0, "S64")]))


def path_of(versions: Versions, sha256: str) -> str:
    """Name the artifact that holds a photo's small picture."""
    return versions.path("thumbnail", versions.thumbnail_key(sha256))
