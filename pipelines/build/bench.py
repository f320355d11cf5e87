"""What every stage is given: where it finds its input, and how it leaves its output."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import pyarrow as pa

from nostalgin_core import photo
from nostalgin_core.model import ImageFormat
from nostalgin_core.records import Photo, Rejection
from nostalgin_core.rectify import Watermark
from pipelines import index
from pipelines.build.attempt import Attempt
from pipelines.build.isolation import Isolation
from pipelines.build.supervisor import Limits
from pipelines.index.plan import PhotoRef
from pipelines.models import Models, Once
from pipelines.store import Aside, Damaged, Store
from pipelines.store.versions import Versions

Make = Callable[[], pa.Table | Rejection]


@dataclass(frozen=True)
class Bench:
    """Where a stage finds its input and leaves its output."""

    store: Store
    versions: Versions
    models: Models
    limits: Limits = field(default_factory=Limits)
    retry: bool = False  # what ended its process in an earlier run
    image_format: ImageFormat = "webp"  # of the models' textures
    mark: bytes = b""  # the file of the copies' watermark; empty: none is taken out
    damaged: list[str] = field(default_factory=list, compare=False)  # met and dropped
    found: list[str] = field(default_factory=list, compare=False)  # and not made
    made: list[str] = field(default_factory=list, compare=False)

    def attempt(self, function: Callable[..., Any], stage: str, *tools: Any) -> Attempt:
        """Have a stage's function work on elements, each where it can harm no other."""
        return Attempt(Work(function, self, tools), stage, self._isolation())

    def _isolation(self) -> Isolation | None:
        if not self.limits.seconds:
            return None
        return Isolation(self.limits, Aside(self.store, self.versions, self.retry))

    def keep(self, path: str, make: Make) -> Rejection | None:
        """Make an artifact unless it is there; tell its rejection, if it is one."""
        try:
            verdict = self.store.verdict(path)
        except Damaged:
            self.drop(path)
            verdict = False
        if verdict is False:
            made = make()
            self.store.keep(path, made)
            self.made.append(path)
            return made if isinstance(made, Rejection) else None
        self.found.append(path)
        return verdict if isinstance(verdict, Rejection) else None

    def read(
        self, path: str, again: Callable[[], Any], columns: Sequence[str] | None = None
    ) -> pa.Table:
        """Read an artifact, or some columns; a damaged one is made `again` first."""
        try:
            return self.store.read_table(path, columns)
        except (Damaged, FileNotFoundError):  # the latter of a pack that is
            self.drop(path)
            again()
            return self.store.read_table(path, columns)

    def drop(self, path: str) -> None:
        """Drop a damaged artifact, and count it."""
        self.store.drop(path)
        self.damaged.append(path)

    def network(self, name: str) -> Once:
        """Name a network, to be loaded by the process that first calls it."""
        return Once(self.models, name)

    @property
    def watermark(self) -> Watermark | None:
        """Give the mark that the archive's copies bear, if it is to be taken out."""
        return index.loaded_watermark(self.mark)

    def decoded(self, ref: PhotoRef) -> Photo | Rejection:
        """Read and decode a photo again: cheaper than carrying its pixels."""
        return photo.decode(Store(ref.root).read_bytes(ref.name), name=ref.sha256[:16])


@dataclass(frozen=True)
class Work:
    """A stage's function with its bench, and its network if it has one."""

    function: Callable[..., Any]
    bench: Bench
    tools: tuple[Any, ...] = ()

    def __call__(self, ref: Any) -> Any:
        """Work on one element."""
        self.bench.found.clear()  # what is left of one that crashed
        self.bench.made.clear()
        return self.function(ref, self.bench, *self.tools)

    def noticed(self) -> tuple[int, bool]:
        """Tell how much was made again, and whether all was there; then forget it."""
        bench = self.bench
        healed, skipped = len(bench.damaged), bool(bench.found and not bench.made)
        for one in (bench.damaged, bench.found, bench.made):
            one.clear()
        return healed, skipped
