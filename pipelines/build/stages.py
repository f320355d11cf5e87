"""The stages as transforms: each takes references and gives references.

Pixels never travel: a stage reads its artifact and the photo, works, and writes its own
artifact. What passes between stages and through shuffles is a photo's name, its hash
and a facade's number.
"""

import hashlib
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import apache_beam as beam
import pyarrow as pa
from apache_beam import pvalue

from nostalgin_core import inpaint, matte, quantise, rectify, segment
from nostalgin_core.records import (
    Elevation,
    Instance,
    Photo,
    Rejection,
    Seen,
    Standpoint,
)
from nostalgin_core.steps import rounded
from pipelines import site
from pipelines.build import artifacts
from pipelines.build.attempt import Attempt
from pipelines.build.bench import Bench
from pipelines.index.plan import PhotoRef
from pipelines.models import Once
from pipelines.store import Store, tables


@dataclass(frozen=True)
class FacadeRef:
    """One facade of a photo, and what is known of it in numbers."""

    photo: PhotoRef
    seen: Seen
    standpoint: Standpoint  # of the photo's camera

    @property
    def key(self) -> str:
        """Name the facade in rejections."""
        return self.photo.name


@dataclass
class Read(beam.PTransform):
    """Photos by name in, photos by content out; a missing file is rejected."""

    def expand(self, photos: pvalue.PCollection) -> Any:
        """Wire the stage."""
        return photos | Attempt(read, stage="photo")


def read(ref: PhotoRef) -> PhotoRef | Rejection:
    """Hash a photo's bytes."""
    try:
        data = Store(ref.root).read_bytes(ref.name)
    except (OSError, ValueError) as problem:  # the latter of a name that none can have
        why = getattr(problem, "strerror", None) or str(problem)
        remedy = f"{ref.root}/{ref.name}: {why}; restore the file or mend the row"
        return Rejection(ref.name, "photo", "unreadable file", remedy)
    return replace(ref, sha256=hashlib.sha256(data).hexdigest())


@dataclass
class Segment(beam.PTransform):
    """Photos in; photos out whose instances are in the store."""

    bench: Bench

    def expand(self, photos: pvalue.PCollection) -> Any:
        """Wire the stage."""
        network = self.bench.network("segment")
        return photos | self.bench.attempt(segmented, "segment", network)


@dataclass
class Matte(beam.PTransform):
    """Segmented photos in; photos out whose facades and occluders are in the store."""

    bench: Bench

    def expand(self, photos: pvalue.PCollection) -> Any:
        """Wire the stage."""
        return photos | self.bench.attempt(matted, "matte")


@dataclass
class Rectify(beam.PTransform):
    """Matted photos in; facades out whose elevations are in the store."""

    bench: Bench

    def expand(self, photos: pvalue.PCollection) -> Any:
        """Wire the stage."""
        return photos | self.bench.attempt(rectified, "rectify")


@dataclass
class Inpaint(beam.PTransform):
    """Rectified facades in; facades out whose finished elevations are in the store."""

    bench: Bench

    def expand(self, facades: pvalue.PCollection) -> Any:
        """Wire the stage."""
        network = self.bench.network("inpaint")
        return facades | self.bench.attempt(inpainted, "inpaint", network)


def segmented(ref: PhotoRef, bench: Bench, network: Once) -> PhotoRef | Rejection:
    """Keep what the network finds in a photo."""

    def make() -> pa.Table | Rejection:
        picture = bench.decoded(ref)
        if isinstance(picture, Rejection):
            return picture
        found = segment.segment(picture, network)
        if isinstance(found, Rejection):
            return found
        return tables.table(Instance, quantise.instances(found))

    path = bench.versions.path("segment", bench.versions.segment_key(ref.sha256))
    return unless(bench.keep(path, make), ref)


def matted(ref: PhotoRef, bench: Bench) -> PhotoRef | Rejection:
    """Keep the facades and occluders of a photo, with their soft masks."""

    def make() -> pa.Table | Rejection:
        picture, versions = needed(bench.decoded(ref)), bench.versions
        path = versions.path("segment", versions.segment_key(ref.sha256))
        again = partial(segmented, ref, bench, bench.network("segment"))
        found = tables.records(Instance, bench.read(path, again))
        result = matte.matte(picture, tuple(found))
        return (
            result if isinstance(result, Rejection) else artifacts.matted_table(result)
        )

    path = bench.versions.path("matte", bench.versions.matte_key(ref.sha256))
    return unless(bench.keep(path, make), ref)


def rectified(ref: PhotoRef, bench: Bench) -> list[FacadeRef | Rejection]:
    """Keep the elevations of a photo, and fan out to its facades."""
    versions = bench.versions
    path = versions.path("rectify", versions.rectify_key(ref.sha256))
    before = versions.path("matte", versions.matte_key(ref.sha256))

    def make() -> pa.Table | Rejection:
        picture = needed(bench.decoded(ref))
        again = partial(matted, ref, bench)
        result = artifacts.matted_from(bench.read(before, again))
        views = tuple(map(rounded, rectify.rectify(picture, result)))
        return artifacts.rectified_table(picture, result, views)

    rejection = bench.keep(path, make)
    if rejection is not None:
        return [named(rejection, ref.name)]
    rows = bench.read(path, partial(bench.keep, path, make), artifacts.NUMBERS)
    outcomes = artifacts.seen_from(rows)
    return [
        named(one, ref.name) if isinstance(one, Rejection) else FacadeRef(ref, *one)
        for one in outcomes
    ]


def inpainted(ref: FacadeRef, bench: Bench, network: Once) -> FacadeRef | Rejection:
    """Keep one finished elevation."""
    versions, sha256 = bench.versions, ref.photo.sha256

    def make() -> pa.Table | Rejection:
        before = versions.path("rectify", versions.rectify_key(sha256))
        found = bench.read(before, partial(rectified, ref.photo, bench))
        view = artifacts.elevation_from(found, ref.seen.facade)
        return tables.table(Elevation, [inpaint.inpaint(view, network)])

    path = versions.path("inpaint", versions.inpaint_key(sha256, ref.seen.facade))
    bench.keep(path, make)
    return ref


@dataclass
class Thumbnail(beam.PTransform):
    """Photos in; photos out whose thumbnails are in the store."""

    bench: Bench

    def expand(self, photos: pvalue.PCollection) -> Any:
        """Wire the stage."""
        return photos | self.bench.attempt(shrunk, "thumbnail")


def shrunk(ref: PhotoRef, bench: Bench) -> list[PhotoRef]:
    """Keep a small picture of a photo; one that can't be read is told of elsewhere."""

    def make() -> pa.Table | Rejection:
        picture = bench.decoded(ref)
        if isinstance(picture, Rejection):
            return picture
        small = site.thumbnail(picture.image)
        return pa.Table.from_pylist([{"picture": small}], artifacts.THUMBNAIL)

    path = bench.versions.path("thumbnail", bench.versions.thumbnail_key(ref.sha256))
    return [ref] if bench.keep(path, make) is None else []


def needed(picture: Photo | Rejection) -> Photo:
    """Insist on a photo that an earlier stage has decoded already.

    Raises:
        ValueError: if the file has changed since.
    """
    if isinstance(picture, Rejection):
        raise ValueError(  # noqa: TRY004 - its type is not what is wrong
            f"{picture.key} changed during the run: {picture.reason}"
        )
    return picture


def unless(rejection: Rejection | None, ref: PhotoRef) -> PhotoRef | Rejection:
    """Pass a photo on unless it was rejected."""
    return ref if rejection is None else named(rejection, ref.name)


def named(rejection: Rejection, name: str) -> Rejection:
    """Name a rejected photo by its file, as the manifest does.

    Artifacts know a photo by its content alone, since two names may share it.
    """
    detail = rejection.detail.replace(rejection.key, name)
    return replace(rejection, key=name, detail=detail)
