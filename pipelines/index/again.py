"""What `index` was asked with is kept, so that a folder that grew is indexed again.

    CITY/indexed.json      the question, and a hash of what it was answered from

It is asked again where the answer may be another one: other names in the folder, other
bytes of a list, of places or of a profile, another release; where boards were looked
at, other photographs, too. What comes from the web is brought once, so that there is
nothing to ask again, and a manifest that people have mended is theirs.
"""

import contextlib
import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields, replace
from importlib.metadata import version as release
from pathlib import Path
from typing import Any, Final, NamedTuple, Self, get_args

from pipelines import bounded
from pipelines.index import lists, watermarks
from pipelines.index.anchors import Asked
from pipelines.index.images import Nothing, images
from pipelines.index.index import Draft, Indexed, Question, draft, put, replaceable
from pipelines.index.profiles import USUAL, built_in, profile
from pipelines.index.web import is_web
from pipelines.index.witnesses import Ask, Heard, Which
from pipelines.store import Store, key_of

RECORD: Final = "indexed.json"
FILES: Final = ("catalogue", "outlines", "places", "streets", "profile")


@dataclass(frozen=True)
class Wish:
    """What `index` is asked with; paths are absolute, "" is what is not told."""

    photos: str
    catalogue: str = ""
    encoding: str = ""
    blocks: tuple[str, ...] = ()
    credit: str = ""
    title: str = ""
    boards: Which = "silent"
    profile: str = USUAL
    outlines: str = ""
    outline_key: str = ""
    outline_crs: str = ""
    places: str = ""
    place: str = ""
    streets: str = ""

    @classmethod
    def told(cls, photos: str, **words: Any) -> Self:
        """Take words and paths as they were told in this folder; None is not told."""
        given = {name: word for name, word in words.items() if word}
        for name in {*FILES} & set(given):
            given[name] = resolved(str(given[name]), name)
        return cls(resolved(photos, "photos"), **given)

    @property
    def lasting(self) -> bool:
        """Tell whether another answer may come of it: nothing of it is on the web."""
        near = not lists.presents(Path(self.photos))
        return near and not any(map(is_web, (self.photos, self.catalogue)))

    @property
    def near(self) -> bool:
        """Tell whether all of it lies on this machine, as all that is kept does."""
        paths = (getattr(self, name) for name in ("photos", *FILES))
        return not any("://" in path or is_web(path) for path in paths)

    def question(self) -> Question:
        """Give what it tells beside photographs and list as `index` takes it.

        Raises:
            Nothing: if its profile makes no sense.
        """
        paths = {
            name: Path(getattr(self, name)) if getattr(self, name) else None
            for name in ("outlines", "places", "streets")
        }
        words = {n: getattr(self, n) for n in ("outline_key", "outline_crs", "place")}
        told = {n: getattr(self, n) for n in ("blocks", "credit", "title", "encoding")}
        archive = profile(self.profile)
        return Question(**told, places=Asked(**paths, **words), archive=archive)


@dataclass(frozen=True)
class Kept:
    """A wish that was fulfilled."""

    wish: Wish
    seen: str  # a hash of what the manifest followed from
    looked: bool  # at boards
    astray: bool  # most photographs found no place, and that was taken


def resolved(told: str, name: str) -> str:
    """Give a path from the root; an address and the name of a profile stay."""
    if "://" in told or (name == "profile" and told in built_in()):
        return told
    return os.path.abspath(told)  # noqa: PTH100 - a link stays a link


def fulfilled(
    wish: Wish,
    city: str,
    *,
    ask: Ask | None,
    force: bool = False,
    tell: lists.Tell = lists.silent,
) -> Indexed:
    """Index as it is wished, and keep the wish.

    Raises:
        Nothing: as `index`.
    """
    store = Store(city)
    mended = replaceable(store, wish.credit, force=force)
    return kept(store, wish, mended, drafted(wish, city, ask=ask, tell=tell))


def renewed(
    known: Kept, city: str, *, ask: Ask | None, tell: lists.Tell = lists.silent
) -> Indexed:
    """Index again as it was wished before.

    Raises:
        Nothing: as `index`; or if most photographs found no place, as they did before:
            then the manifest stays.
    """
    made = drafted(known.wish, city, ask=ask, tell=tell)
    told = made.draft.indexed
    if told.astray and not known.astray:
        raise Nothing(
            f"{len(told.without_front)} of {told.photos} photos find no place any "
            f"more: is {known.wish.catalogue or known.wish.photos} whole? The manifest "
            "stays; `nostalgin index` replaces it"
        )
    return kept(Store(city), known.wish, None, made)


class Drafted(NamedTuple):
    """A manifest that is yet to be written, and what it followed from."""

    draft: Draft
    seen: str


def drafted(
    wish: Wish, city: str, *, ask: Ask | None, tell: lists.Tell = lists.silent
) -> Drafted:
    """Index as it is wished, and write nothing.

    Raises:
        Nothing: as `index`.
    """
    looked: list[str] = []

    def told(root: str, names: Sequence[str]) -> Mapping[str, Heard]:
        looked.extend(names)
        return ask.boards(root, names) if ask is not None else {}

    asker = None if ask is None else replace(ask, boards=told)
    # What changes from now on is seen the next time.
    both = (facts(wish, city), stamps(wish, city)) if wish.lasting else ("", "")
    where = (wish.photos, wish.catalogue or None, city)
    made = draft(*where, wish.question(), ask=asker, tell=tell)
    return Drafted(made, key_of(both[0], both[1] if looked else ""))


def kept(
    store: Store, wish: Wish, mended: tuple[str, bytes] | None, made: Drafted
) -> Indexed:
    """Write a manifest, and what it was asked with."""
    done = put(store, made.draft, mended)
    if not wish.lasting:
        store.remove(RECORD)
        return done
    record = Kept(wish, made.seen, looked=done.boards > 0, astray=done.astray)
    text = json.dumps(asdict(record), indent=1, sort_keys=True) + "\n"
    store.write_bytes(RECORD, text.encode())
    return done


def known(store: Store) -> Kept | None:
    """Read what a city folder was indexed with; None if nothing tells it.

    Nor does one that leads off this machine, which `index` never keeps: a folder of
    another's could have us fetch what it names.
    """
    try:
        told = json.loads(store.read_bytes(RECORD))
        cells = told.pop("wish")
        words: dict[str, Any] = {n.name: str(cells[n.name]) for n in fields(Wish)}
        words["blocks"] = tuple(map(str, cells["blocks"]))
        wish = Wish(**words)
        if words["boards"] in get_args(Which) and wish.near and wish.lasting:
            return Kept(wish, **told)
    except (OSError, ValueError, TypeError, KeyError, AttributeError):
        pass
    return None


def outdated(one: Kept, city: str) -> bool:
    """Tell whether another manifest may come of the same wish now.

    Raises:
        Nothing: if there is no photograph any more.
    """
    files = stamps(one.wish, city) if one.looked else ""
    return key_of(facts(one.wish, city), files) != one.seen


def facts(wish: Wish, city: str) -> str:
    """Hash what a manifest follows from, the photographs' content apart.

    Raises:
        Nothing: if there is no photograph.
    """
    names, refused = images(Path(wish.photos), city)
    told = [release("nostalgin"), json.dumps(asdict(wish), sort_keys=True)]
    told += [contents(getattr(wish, name)) for name in FILES]
    own = profile(wish.profile).own_mark
    told += [watermarks.sha256(own)] if own else []
    return key_of(*told, *names, "", *(one.key for one in refused))


def contents(path: str) -> str:
    """Hash a file; "" if there is none, which `index` tells."""
    with contextlib.suppress(OSError, ValueError):  # a path may hold a NUL
        return hashlib.sha256(bounded.read(path, bounded.TABLE_BYTES)).hexdigest()
    return ""


def stamps(wish: Wish, city: str) -> str:
    """Hash the sizes of the photographs' files and when they were changed."""
    if wish.boards == "none":
        return ""
    names, _ = images(Path(wish.photos), city)
    return key_of(*map(repr, Store(wish.photos).stamps(names)))
