"""What walls wear: elevations, filled from neighbours' photographs, then inpainted.

One element is one front. Its worker reads the elevations of the few photographs that
show it, so that no pixels cross a shuffle. A front that no other photograph shows goes
on as it is, and leaves nothing in the store.
"""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import apache_beam as beam
import pyarrow as pa
from apache_beam import pvalue

from nostalgin_core import borrow, inpaint
from nostalgin_core.borrow import Lender
from nostalgin_core.records import Elevation
from pipelines.build import artifacts
from pipelines.build.artifacts import Lent
from pipelines.build.bench import Bench
from pipelines.build.stages import FacadeRef, rectified
from pipelines.models import Once
from pipelines.store import tables
from pipelines.store.versions import Versions


@dataclass(frozen=True)
class Worn:
    """A facade that a wall wears, and who else shows the same front."""

    own: FacadeRef
    front_id: str
    lenders: tuple[FacadeRef, ...] = ()
    lent: Lent | None = None  # what came of it; None: there was nobody to ask

    @property
    def key(self) -> str:
        """Name the front's photo in rejections."""
        return self.own.photo.name

    def borrow_key(self, versions: Versions) -> str:
        """Key the elevation that neighbours lent to."""
        every = (self.own, *self.lenders)
        return versions.borrow_key(
            (_rectify_key(one, versions), one.seen.facade) for one in every
        )

    def inpaint_key(self, versions: Versions) -> str:
        """Key the finished elevation."""
        if self.lenders:
            return versions.lent_key(self.borrow_key(versions))
        photo, facade = self.own.photo, self.own.seen.facade
        return versions.inpaint_key(photo.sha256, facade, *photo.drawn)


def _rectify_key(ref: FacadeRef, versions: Versions) -> str:
    return versions.rectify_key(ref.photo.sha256, *ref.photo.drawn)


@dataclass
class Borrow(beam.PTransform):
    """Worn facades in; the same out, what neighbours lend to them in the store."""

    bench: Bench

    def expand(self, worn: pvalue.PCollection) -> Any:
        """Wire the stage."""
        return worn | self.bench.attempt(borrowed, "borrow")


@dataclass
class Inpaint(beam.PTransform):
    """Worn facades in; the same out, their finished elevations in the store."""

    bench: Bench

    def expand(self, worn: pvalue.PCollection) -> Any:
        """Wire the stage."""
        network = self.bench.network("inpaint")
        return worn | self.bench.attempt(inpainted, "inpaint", network)


def borrowed(one: Worn, bench: Bench) -> Worn:
    """Keep an elevation with what other photographs of its front lend to it."""
    if not one.lenders:
        return one
    path = bench.versions.path("borrow", one.borrow_key(bench.versions))
    make = partial(_borrowed, one, bench)
    bench.keep(path, make)
    again = partial(bench.keep, path, make)
    return replace(
        one, lent=artifacts.lent_from(bench.read(path, again, artifacts.LENT))
    )


def _borrowed(one: Worn, bench: Bench) -> pa.Table:
    """Fill a front from its neighbours' elevations.

    The artifact's key names all of them: one that can't be read now makes the front
    crash, so that the next run reads it again.
    """
    lenders = [Lender(each.seen.photo, _elevation(each, bench)) for each in one.lenders]
    return artifacts.borrowed_table(borrow.borrow(_elevation(one.own, bench), lenders))


def _elevation(ref: FacadeRef, bench: Bench) -> Elevation:
    """Read a facade's elevation; a damaged one is made again."""
    versions = bench.versions
    path = versions.path("rectify", _rectify_key(ref, versions))
    rows = bench.read(path, partial(rectified, ref.photo, bench))
    return artifacts.elevation_from(rows, ref.seen.facade)


def inpainted(one: Worn, bench: Bench, network: Once) -> Worn:
    """Keep one finished elevation."""
    versions = bench.versions

    def make() -> pa.Table:
        if one.lenders:
            before = versions.path("borrow", one.borrow_key(versions))
            rows = bench.read(before, partial(borrowed, one, bench))
            view = tables.records(Elevation, rows)[0]
        else:
            view = _elevation(one.own, bench)
        return tables.table(Elevation, [inpaint.inpaint(view, network)])

    bench.keep(versions.path("inpaint", one.inpaint_key(versions)), make)
    return one
