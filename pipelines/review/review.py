"""What a person is to look at in a city folder: readings, findings, fronts as drawn.

Photographs that somebody is to decide about come first; of a large archive the page
shows so many, and tells how many it leaves out.
"""

import base64
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from nostalgin_core import photo
from nostalgin_core.records import Front, Rejection
from pipelines import bounded, check, corrections, site
from pipelines.check.finding import Finding
from pipelines.corrections import Found
from pipelines.corrections.corrections import CORRECTION_BYTES, LINES
from pipelines.index import manifest
from pipelines.index.roots import located, rooted
from pipelines.index.row import Row
from pipelines.review.doubts import Told, told
from pipelines.review.readings import Reading, crop, readings
from pipelines.store import Store
from pipelines.store.versions import Versions

SHOWN_PX: Final = 900  # the longest side of a photograph on the page
MOST_OF_A_KIND: Final = 50  # findings
SOME: Final = 8  # blocks that a message names
LONGEST: Final = 40  # letters of a block's name there
ASIDE: Final = (
    "move it elsewhere to begin a new one: the page saves the old lines with the new"
)


class Unkept(ValueError):  # noqa: N818 - it reads as what it is about
    """Corrections that a page's file would lose, with what to do about it."""


@dataclass(frozen=True, eq=False)
class Picture:
    """One photograph, what is found on it and what is told of it."""

    name: str
    image: str  # a data URI; empty: it can't be read
    size_px: tuple[int, int]  # width and height of the photograph itself
    lots: str  # block-lot that it shows now
    fronts: tuple[Front, ...]
    reading: Reading | None
    crop: str  # of its board, a data URI; empty: there is none
    findings: tuple[Finding, ...]
    found: tuple[Found, ...]

    @property
    def meant(self) -> Found | None:
        """Give the front that it is a record of, if one was found."""
        targets = [one for one in self.found if one.target]
        return max(targets, key=lambda one: one.area_px, default=None)


@dataclass(frozen=True, eq=False)
class Review:
    """All that the page shows."""

    pictures: tuple[Picture, ...]
    left_out: int  # photographs
    findings: Mapping[str, tuple[Finding, ...]]  # by kind, the first of each
    counts: Mapping[str, int]  # of findings, by kind
    verdicts: Mapping[str, int]  # of readings
    warned: Told  # by `index`
    given: str  # corrections.jsonl as it is


def review(store: Store, *, blocks: Sequence[str] = (), most: int) -> Review:
    """Gather what is to be looked at; nothing is written.

    Raises:
        Unusable: if the manifest can't be read, or has none of a block that is wanted.
        Unkept: if the page could not save the corrections that are given already.
    """
    given = lines(store)
    by_row: dict[str, list[Finding]] = defaultdict(list)
    kinds: dict[str, list[Finding]] = defaultdict(list)
    for one in check.check(store, pictures=False):
        by_row[one.row].append(one)
        kinds[one.kind].append(one)
    read = readings(store)
    made = corrected(store)
    there(store, blocks, made.rows)
    rows: dict[str, list[Row]] = defaultdict(list)
    for row in made.rows:
        if row.photo and (not blocks or (row.front and row.front.block in blocks)):
            rows[row.photo].append(row)
    names = sorted(rows, key=lambda name: urgent(name, rows[name], read, by_row))
    versions = corrections.published(store)
    return Review(
        pictures=tuple(
            picture(
                name,
                rows[name],
                store,
                versions=versions,
                made=made,
                reading=read.get(name),
                by_row=by_row,
            )
            for name in names[:most]
        ),
        left_out=len(names[most:]),
        findings={kind: tuple(some[:MOST_OF_A_KIND]) for kind, some in kinds.items()},
        counts={kind: len(some) for kind, some in kinds.items()},
        verdicts=Counter(one.verdict for one in read.values()),
        warned=told(store, made.rows),
        given=given,
    )


def there(store: Store, blocks: Sequence[str], rows: Sequence[Row]) -> None:
    """Insist on blocks that the manifest has.

    Raises:
        Unusable: if it has one of them not; it names some that it has.
    """
    known = {row.front.block for row in rows if row.front}
    strange = [one for one in blocks if one not in known]
    if strange:
        some = sorted(known, key=manifest.natural)[:SOME]
        shown = ", ".join(one[:LONGEST] for one in some) or "none"
        words = f"has no block {strange[0][:LONGEST]!r}: its first are {shown}"
        raise manifest.Unusable(f"{store.root}/{manifest.CSV} {words}")


def corrected(store: Store) -> corrections.Applied:
    """Read the manifest, as it is corrected so far."""
    rows = located(manifest.read(store), store.root, ()).rows
    made = corrections.applied(rows, corrections.read(store))
    return corrections.fitting(made, store)


def urgent(
    name: str,
    rows: Sequence[Row],
    read: Mapping[str, Reading],
    by_row: Mapping[str, Sequence[Finding]],
) -> tuple[bool, bool, int]:
    """Order photographs: those first about which somebody is to decide."""
    known = read.get(name)
    findings = [one for row in rows for one in by_row.get(row.key, ())]
    grave = any(one.grave for one in findings)
    return (
        not (grave or (known is not None and known.open)),
        not findings,
        rows[0].number,
    )


def picture(
    name: str,
    rows: Sequence[Row],
    store: Store,
    *,
    versions: Versions | None,
    made: corrections.Applied,
    reading: Reading | None,
    by_row: Mapping[str, Sequence[Finding]],
) -> Picture:
    """Gather what is known of one photograph."""
    root = rooted(rows[0].root, store.root)
    image, size_px, sha256 = shown(root, name)
    found: tuple[Found, ...] = ()
    if versions is not None and sha256:
        drawn = (made.outlines.get(name, ""), made.quads.get(name, ""))
        found = corrections.found(store, versions, sha256, *drawn)
        found = found or corrections.found(store, versions, sha256)
    fronts = tuple(row.front for row in rows if row.front is not None)
    return Picture(
        name=name,
        image=image,
        size_px=size_px,
        lots=", ".join(dict.fromkeys(f"{one.block}-{one.lot}" for one in fronts)),
        fronts=fronts,
        reading=reading,
        crop=crop(reading.crop, store) if reading else "",
        findings=tuple(one for row in rows for one in by_row.get(row.key, ())),
        found=found,
    )


def shown(root: str, name: str) -> tuple[str, tuple[int, int], str]:
    """Read a photograph for the page; give its size, and the hash of its content."""
    try:
        data = Store(root).read_bytes(name, bounded.PHOTO_BYTES)
    except (OSError, ValueError):
        return "", (0, 0), ""
    decoded = photo.decode(data, name=name)
    if isinstance(decoded, Rejection):
        return "", (0, 0), ""
    height, width = decoded.image.shape
    small = site.thumbnail(decoded.image, longest_px=SHOWN_PX)
    coded = base64.b64encode(small).decode()
    return f"data:image/webp;base64,{coded}", (width, height), corrections.hashed(data)


def lines(store: Store) -> str:
    """Read the corrections that are given already, to which the page adds.

    Raises:
        Unkept: if they are there, but not whole in what the page would save.
    """
    try:
        text = store.read_bytes(LINES, CORRECTION_BYTES).decode("utf-8-sig")
    except FileNotFoundError:
        return ""
    except OSError as problem:
        why = f"{LINES}: {problem.strerror or problem}"
        raise Unkept(f"{why}; {ASIDE}") from problem
    except UnicodeDecodeError as problem:
        why = f"{LINES}: byte {problem.start + 1:,} is not UTF-8"
        raise Unkept(f"{why}; save it as UTF-8, or {ASIDE}") from problem
    return text if not text or text.endswith("\n") else f"{text}\n"
