"""A city folder looked over: rows, corrections, files and pictures."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path

from nostalgin_core.catalogue import NAMELESS
from nostalgin_core.records import Rejection
from pipelines import corrections
from pipelines.check import copies, rows
from pipelines.check.finding import Finding
from pipelines.index import PROFILE, Nothing, manifest, of_city, seldom
from pipelines.index.roots import located, rooted
from pipelines.index.row import Row
from pipelines.store import Store


@seldom()
def check(store: Store, *, pictures: bool = True) -> tuple[Finding, ...]:
    """Look over a city folder, and write nothing; `pictures` are looked at, or not.

    Raises:
        Unusable: if its manifest can't be read.
    """
    found = located(manifest.read(store, whole=False), store.root, ())
    given = corrections.read(store)
    made = corrections.fitting(corrections.applied(found.rows, given), store)
    told = [rejected(one) for one in (*found.rejections, *made.rejections)]
    told += rows.schema(found.warnings)
    told += of_names(store, made.rows)
    for look in (rows.rights, rows.streets, rows.widths):
        told += look(made.rows)
    told += of_files(store, made.rows, pictures=pictures)
    return tuple(sorted(told, key=lambda one: (not one.grave, one.kind)))


def of_names(store: Store, every: Sequence[Row]) -> Iterator[Finding]:
    """Look at keys, by the profile that the city was indexed with."""
    try:
        naming = of_city(store).naming
    except (Nothing, OSError) as problem:
        naming, remedy = NAMELESS, "index again, with --profile"
        yield Finding("profile", PROFILE, str(problem), remedy, grave=True)
    yield from rows.keys(every, naming)


def of_files(
    store: Store, every: Sequence[Row], *, pictures: bool
) -> Iterator[Finding]:
    """Look at the photographs' files: are they there, and are they different?"""
    first: dict[str, Row] = {}
    lots: dict[str, set[str]] = defaultdict(set)
    lost: set[str] = set()
    roots: dict[str, str] = {}
    for row in every:
        if not row.photo:
            continue
        if row.root not in roots:
            roots[row.root] = rooted(row.root, store.root)
        where = roots[row.root]
        name = f"{where}/{row.photo}"
        if pictures and row.front is not None:
            lots[name].add(f"{row.front.block}-{row.front.lot}")
        if name in first:
            continue
        first[name] = row
        if not present(where, row.photo):
            lost.add(name)
            remedy = "restore the file, or mend root and photo"
            yield Finding("missing file", row.key, name, remedy, grave=True)
    if pictures:
        here = [one for one in first if one not in lost and "://" not in one]
        files = {name: Path(name) for name in here}
        sure = {name: frozenset(own) for name, own in lots.items()}
        keys = {name: row.key for name, row in first.items()}
        yield from copies.same_files(files, sure, keys)
        yield from copies.alike(files, sure, keys)


def present(where: str, photo: str) -> bool:
    """Tell whether a photograph's file is there."""
    if "://" in where:
        return there(where, photo)
    return Path(f"{where}/{photo}").is_file()


def there(root: str, photo: str) -> bool:
    """Tell whether a file is there; where nobody answers, it is not."""
    try:
        return Store(root).exists(photo)
    except (OSError, ValueError):
        return False


def rejected(one: Rejection) -> Finding:
    """Tell of a row that a build would reject."""
    words, _, remedy = one.detail.rpartition(": ")
    return Finding(one.reason, one.key, words or one.detail, remedy, grave=True)
