"""What is asked for as the city folder stands now, without a word written."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import pyarrow as pa

from pipelines import build, index
from pipelines.build import Corrected, anchored, told_of_run
from pipelines.index import asked, manifest, source
from pipelines.index.source import PARQUET, Source
from pipelines.models import Models
from pipelines.reprocess.published import Published, published
from pipelines.store import Store, runs
from pipelines.store.versions import Versions


@dataclass(frozen=True)
class Now:
    """A manifest, what people corrected, places, and the stages' versions."""

    store: Store
    there: Source
    mended: Corrected
    anchors: index.Anchors
    versions: Versions
    schemes: tuple[str, ...]
    png: bool  # the models' textures are PNG, as the published run wrote them

    @property
    def run(self) -> str:
        """Name the run that a build would be."""
        told = self.there.sha256 + self.mended.sha256 + self.anchors.sha256
        words = build.written_words("", self.schemes, png=self.png)
        return runs.run_id(told, self.versions, words)

    @property
    def rows_sha256(self) -> str:
        """Hash what the rows follow from."""
        given = (self.there, self.mended, self.anchors, self.schemes)
        return told_of_run(*given)["rows"]

    def tables(self, before: Published) -> Iterator[pa.Table]:
        """Read the rows that are asked for, `GROUP` at a time.

        Where nothing is told otherwise than to the published run, they are its own.

        Raises:
            Unusable: if the manifest can't be read to its end.
        """
        if before.rows_sha256 == self.rows_sha256:
            yield from before.asked()
            return
        cells = (one for batch in self.there.batches() for one in batch)
        rows = self.mended.rows
        results = manifest.checked(cells) if rows is None else rows
        sorting = asked.Sorting(self.store.root, self.schemes, (1, 1), lambda _: None)
        yield from asked.told_as(sorting.each(results))


def now(
    store: Store,
    models: Models,
    *,
    schemes: Sequence[str] = (),
    there: Source | None = None,
) -> Now:
    """Read what is asked for; a manifest that was mended is read as a build would.

    `there` is a manifest that is yet to be written.

    Options that change what comes of a run are those of the run that is shown.

    Raises:
        Unusable: if it can't be read.
        Unlocked: if a network has no lock.
    """
    there = there or source.found(store)
    manifest.noticed(there)
    if there.mended:
        found = manifest.read(store)
        if not found.rejections:
            title, kept = there.title, there.kept
            data = manifest.again(found)[1]
            there = Source(store.root, PARQUET, data, title, kept=kept)
    mended, anchors = build.corrected(store, there), anchored(store, there)
    streets = build.Streets(anchors.widths_m, anchors.gaps_m)
    mended = replace(mended, streets=streets)
    mark = index.watermark_sha256(build.mark_of(store))
    versions = Versions.present(models, mark=mark)
    options = published(store).told.get("options") or {}
    before = [one for one in str(options.get("allow_schemes", "")).split(",") if one]
    allowed = tuple(sorted({*schemes, *before}))
    png = options.get("no_webp") == "True"
    return Now(store, there, mended, anchors, versions, allowed, png)
