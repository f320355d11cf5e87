"""A city folder looked over: rows, corrections, files and pictures."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path

from nostalgin_core.records import Rejection
from pipelines import corrections
from pipelines.check import copies, rows
from pipelines.check.finding import Finding
from pipelines.index import manifest
from pipelines.index.roots import located, rooted
from pipelines.index.row import Row
from pipelines.store import Store


def check(store: Store, *, pictures: bool = True) -> tuple[Finding, ...]:
    """Look over a city folder, and write nothing; `pictures` are looked at, or not.

    Raises:
        Unusable: if its manifest can't be read.
    """
    found = located(manifest.read(store), store.root, ())
    made = corrections.applied(found.rows, corrections.read(store))
    told = [rejected(one) for one in (*found.rejections, *made.rejections)]
    told += rows.schema(found.warnings)
    for look in (rows.keys, rows.rights, rows.streets, rows.widths):
        told += look(made.rows)
    told += of_files(store, made.rows, pictures=pictures)
    return tuple(sorted(told, key=lambda one: (not one.grave, one.kind)))


def of_files(
    store: Store, every: Sequence[Row], *, pictures: bool
) -> Iterator[Finding]:
    """Look at the photographs' files: are they there, and are they different?"""
    files: dict[str, Path] = {}
    first: dict[str, str] = {}
    lots: dict[str, set[str]] = defaultdict(set)
    for row in every:
        if not row.photo:
            continue
        where = rooted(row.root, store.root)
        name = f"{where}/{row.photo}"
        if row.front is not None:
            lots[name].add(f"{row.front.block}-{row.front.lot}")
        if name in first:
            continue
        first[name] = row.key
        path = Path(where) / row.photo
        if "://" not in where and path.is_file():
            files[name] = path
        elif "://" not in where or not there(where, row.photo):
            remedy = "restore the file, or mend root and photo"
            yield Finding("missing file", row.key, name, remedy, grave=True)
    if pictures:
        sure = {name: frozenset(own) for name, own in lots.items()}
        yield from copies.same_files(files, sure, first)
        yield from copies.alike(files, sure, first)


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
