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
import numpy as np
import pyarrow as pa
from apache_beam import pvalue

from nostalgin_core import quantise, rectify, segment, steps
from nostalgin_core.records import (
    Drawn,
    Instance,
    Photo,
    Rejection,
    Seen,
    Standpoint,
)
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
    watermark: str = ""  # words of one that was taken out of its tones

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
    photos = Store(ref.root)
    try:
        (stamp,) = photos.stamps([ref.name])  # before: what is written later shows
        data = photos.read_bytes(ref.name)
    except (OSError, ValueError) as problem:  # the latter of a name that none can have
        return Rejection(ref.name, "photo", "unreadable file", gone(problem, ref.root))
    size, mtime_ns = stamp or (0, 0)
    sha256 = hashlib.sha256(data).hexdigest()
    return replace(ref, sha256=sha256, size=size, mtime_ns=mtime_ns)


def gone(problem: Exception, root: str) -> str:
    """Tell why a photo can't be read, alike for all of its folder, and the remedy."""
    if isinstance(problem, FileNotFoundError):
        return (
            f"not in {root}: was the folder moved or renamed? run `nostalgin index` "
            "again, or restore the file"
        )
    why = getattr(problem, "strerror", None) or str(problem)
    return f"{why} in {root}; restore the file or mend the row"


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
    declined = bench.keep(path, make)
    if ref.outline and declined is not None and declined.stage == "segment":
        return ref  # a front that is drawn need not be found
    return unless(declined, ref)


def matted(ref: PhotoRef, bench: Bench) -> PhotoRef | Rejection:
    """Keep the facades and occluders of a photo, with their soft masks."""

    def make() -> pa.Table | Rejection:
        picture = needed(bench.decoded(ref))
        result = steps.front(picture, instances(ref, bench), drawn(ref))
        return (
            result if isinstance(result, Rejection) else artifacts.matted_table(result)
        )

    key = bench.versions.matte_key(ref.sha256, ref.outline)
    path = bench.versions.path("matte", key)
    return unless(bench.keep(path, make), ref)


def instances(ref: PhotoRef, bench: Bench) -> tuple[Instance, ...]:
    """Read what the network found in a photo: nothing where it declined."""
    path = bench.versions.path("segment", bench.versions.segment_key(ref.sha256))
    again = partial(segmented, ref, bench, bench.network("segment"))
    if ref.outline and isinstance(bench.store.verdict(path), Rejection):
        return ()
    return tuple(tables.records(Instance, bench.read(path, again)))


def drawn(ref: PhotoRef) -> Drawn:
    """Give what somebody drew on a photo."""
    return Drawn(points(ref.outline), points(ref.quad))


def points(told: str) -> np.ndarray | None:
    """Read points as they are written: x,y x,y ..."""
    pairs = [one.split(",") for one in told.split()]
    return np.array(pairs, np.float64) if pairs else None


def rectified(ref: PhotoRef, bench: Bench) -> list[FacadeRef | Rejection]:
    """Keep the elevations of a photo, and fan out to its facades."""
    versions = bench.versions
    path = versions.path("rectify", versions.rectify_key(ref.sha256, *ref.drawn))
    before = versions.path("matte", versions.matte_key(ref.sha256, ref.outline))

    def make() -> pa.Table | Rejection:
        photo = needed(bench.decoded(ref))
        picture, words = rectify.unmarked(photo, bench.watermark)
        again = partial(matted, ref, bench)
        result = artifacts.matted_from(bench.read(before, again))
        views = steps.straightened(picture, result, drawn(ref))
        return artifacts.rectified_table(picture, result, views, words)

    rejection = bench.keep(path, make)
    if rejection is not None:
        return [named(rejection, ref.name)]
    rows = bench.read(path, partial(bench.keep, path, make), artifacts.NUMBERS)
    outcomes = artifacts.seen_from(rows)
    return [
        named(one, ref.name) if isinstance(one, Rejection) else FacadeRef(ref, *one)
        for one in outcomes
    ]


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
