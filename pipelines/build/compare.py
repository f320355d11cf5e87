"""Facades of different photographs are compared by the worker that places their block.

Their elevations are read here, where they are needed, and never travel. What came of it
is kept, an artifact a block, so that a run that is repeated compares nothing.
"""

import json
from collections.abc import Mapping, Sequence
from functools import lru_cache, partial
from typing import Any, Final, NamedTuple

import pyarrow as pa

from nostalgin_core import views
from nostalgin_core.records import Elevation, Front, Texture
from nostalgin_core.views import Alike, View
from pipelines.build import artifacts
from pipelines.build.bench import Bench
from pipelines.build.stages import FacadeRef, rectified
from pipelines.store import tables

ALIKE: Final = pa.schema(
    [
        pa.field("first", pa.string()),  # a photo's key
        pa.field("first_facade", pa.int64()),
        pa.field("second", pa.string()),
        pa.field("second_facade", pa.int64()),
        pa.field("probability", pa.float64()),  # that both are of one front
    ]
)
PHOTOS: Final = 8  # whose elevations are in memory


class Compared(NamedTuple):
    """What came of comparing a block's facades, and the artifact that holds it."""

    alike: Alike
    path: str = ""  # "": one photograph has nothing to be compared with


def compared(
    fronts: Sequence[Front],
    filed: Mapping[str, Sequence[str]],
    facades: Sequence[FacadeRef],
    bench: Bench,
) -> Compared:
    """Tell how probably facades of a block's photographs are of one front, in pairs."""
    refs = {
        ref.seen.photo: ref.photo
        for ref in reversed(facades)
        if ref.seen.photo in filed
    }
    if len(refs) < 2:
        return Compared({})
    versions = bench.versions
    stretches = [views.stretch(ref.seen, ref.standpoint) for ref in facades]
    rows_of_fronts = [tables.to_row(one) for one in fronts]
    targets = [[*one.texture, one.target_score] for one in stretches]
    asked = json.dumps([rows_of_fronts, sorted(filed.items()), targets])
    keys = sorted(versions.rectify_key(ref.sha256, *ref.drawn) for ref in refs.values())
    path = versions.path("compare", versions.key("compare", asked, *keys))

    @lru_cache(PHOTOS)
    def elevations(photo: str) -> dict[int, Elevation]:
        ref = refs[photo]
        where = versions.path("rectify", versions.rectify_key(ref.sha256, *ref.drawn))
        found = bench.read(where, partial(rectified, ref, bench))
        return artifacts.elevations_from(found)

    def look(texture: Texture) -> View:
        return views.seen_on(elevations(texture[0])[texture[1]])

    def make() -> pa.Table:
        alike = views.compared(fronts, filed, stretches, look)
        rows = [(*a, *b, told) for (a, b), told in alike.items()]
        return pa.Table.from_pylist(
            [dict(zip(ALIKE.names, row, strict=True)) for row in rows], ALIKE
        )

    bench.keep(path, make)
    rows = bench.read(path, partial(bench.keep, path, make)).to_pylist()
    return Compared({pair(row): row["probability"] for row in rows}, path)


def pair(row: Mapping[str, Any]) -> tuple[Texture, Texture]:
    """Name the two facades that a row tells of."""
    first = row["first"], row["first_facade"]
    return first, (row["second"], row["second_facade"])
