"""A folder that grew since it was indexed is indexed again, as it was then."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from pipelines import plural
from pipelines.cli.asking import Whose, asking
from pipelines.cli.index import kept_from_others
from pipelines.console import Voice, fail, laid_out

if TYPE_CHECKING:
    from pipelines.index import Indexed, Kept
    from pipelines.index.source import Source


def outdated(city: str, voice: Voice) -> "Kept | None":
    """Find what a city was indexed with, if another manifest may come of that now.

    One that people have mended is theirs: they are told that nobody looks for others.
    """
    from pipelines import index
    from pipelines.index import manifest
    from pipelines.store import Store

    store = Store(city)
    known = index.known(store)
    if known is None:
        return None
    try:
        if not index.outdated(known, city):
            return None
        mended = manifest.mended_by_hand(store)
    except (index.Nothing, manifest.Unusable) as problem:
        raise fail(str(problem)) from problem
    if mended is None:
        return known
    words = (
        f"{known.wish.photos} or its list is not what it was, but {mended[0]} was "
        "mended by hand: add rows to it, or replace it by `nostalgin index --force`"
    )
    voice.say("warning", f"warning: {words}", warning=words)
    return None


def indexed_again(city: str, voice: Voice, models: str, beam: Sequence[str]) -> None:
    """Index a city again if its folder or its list is not what it was."""
    from pipelines import index

    known = outdated(city, voice)
    if known is None:
        return
    whose = Whose(known.wish.boards)
    ask = asking(city, whose, voice, models=models, beam=beam)

    def work() -> "Indexed":
        return index.renewed(known, city, ask=ask, tell=voice.say)

    made = kept_from_others(city, work)
    voice.say(
        "indexed",
        f"indexed again: {laid_out(made)}, "
        f"{plural.of(len(made.without_front), 'photo')} without a front",
        photos=made.photos,
        fronts=made.fronts,
        blocks=made.blocks,
        photos_without_front=len(made.without_front),
    )


def indexed_dry(city: str, voice: Voice, models: str) -> "Source | None":
    """Give the manifest that would be written, if it may be another; write nothing."""
    from pipelines import index
    from pipelines.index import source

    known = outdated(city, voice)
    if known is None:
        return None
    whose = Whose(known.wish.boards)
    ask = asking(city, whose, voice, models=models, beam=(), dry=True)
    try:
        made = index.drafted(known.wish, city, ask=ask)
    except index.Nothing as problem:
        raise fail(str(problem)) from problem
    return source.of_parquet(made.draft.encoded[1], city)
