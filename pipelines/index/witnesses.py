"""Each photograph's witnesses are heard: its name, the list, and its board if need be.

Whoever can look at boards is handed in: that takes networks and a pipeline, which a
folder whose files are well named needs none of.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final, Literal

from nostalgin_core import placard
from nostalgin_core.catalogue import Entry
from nostalgin_core.placard import Key, Keys, Look
from nostalgin_core.records import Rejection
from pipelines.index import joining
from pipelines.index.profiles import Profile
from pipelines.index.readings import FOLDER, TABLE, TO_MEND, Reading
from pipelines.index.told import stem
from pipelines.store import Store

Which = Literal["silent", "all", "none"]
MOST_TOLD: Final = 8  # contradictions; all are in the table


@dataclass(frozen=True)
class Heard:
    """What was read of a photograph's board, or why nothing was."""

    key: str = ""  # of the photograph's content
    found: str = ""  # how its board was found; empty: it was not
    looks: tuple[Look, ...] = ()
    picture: Callable[[], bytes] = field(default=bytes, compare=False)  # PNG
    why: str = ""
    spoiled: bool = False  # the photograph itself can't be read; `why` has the remedy


Boards = Callable[[str, Sequence[str]], Mapping[str, Heard]]  # of a folder, by name


@dataclass(frozen=True)
class Ask:
    """Whose boards are looked at, and by whom."""

    boards: Boards
    which: Which = "silent"
    processes: int = 1  # of this machine, that may join them with a list


@dataclass(frozen=True)
class Hearing:
    """What all witnesses of all photographs said."""

    readings: Sequence[Reading] = ()
    boards: Mapping[str, Heard] = field(default_factory=dict)  # those looked at

    def keys(self) -> dict[str, Key]:
        """Tell where photographs are put, of those that are put anywhere."""
        each = ((one.photo, one.judged.key) for one in self.readings)
        return {photo: key for photo, key in each if key is not None}

    def doubts(self) -> list[str]:
        """Tell which photographs have witnesses that contradict each other."""
        against = [o for o in self.readings if o.judged.verdict == "contradicted"]
        said = [f"{one.photo}: {one.judged.remedy}" for one in against[:MOST_TOLD]]
        more = len(against) - MOST_TOLD
        return [*said, f"and {more} more: {TABLE} has all"] if more > 0 else said


def without_list(
    names: Sequence[str], ask: Ask | None, root: str, own: Profile
) -> Hearing:
    """Hear file names, and boards of any number."""
    told = own.naming.guessed
    return hear(names, told, lambda _: (), None, ask=ask, root=root, board=own.board)


def with_list(
    names: Sequence[str],
    shown: Mapping[str, Sequence[Entry]],
    entries: Sequence[Entry],
    ask: Ask | None,
    root: str,
    *,
    own: Profile,
) -> Hearing:
    """Hear file names, a list's rows, and boards of the lots that the list has."""
    every = ((entry.block, entry.lot) for entry in entries if ask is not None)
    keys, told = placard.known({*every}), own.naming.told

    def listed(name: str) -> tuple[Key, ...]:
        return listed_keys(name, shown.get(name, ()))

    return hear(names, told, listed, keys, ask=ask, root=root, board=own.board)


def hear(
    names: Sequence[str],
    named: Callable[[str], Key | None],
    listed: Callable[[str], tuple[Key, ...]],
    keys: Keys | None,
    *,
    ask: Ask | None,
    root: str,
    board: str = "",
) -> Hearing:
    """Hear all witnesses of each photograph; a `board` has a pattern, if its own."""
    wanted: list[str] = []
    if ask is not None and ask.which != "none":
        every = ask.which == "all"
        wanted = [one for one in names if every or not (listed(one) or named(one))]
    boards = ask.boards(root, wanted) if ask is not None and wanted else {}
    spelt = {
        name: respelt(one, board) if board else one for name, one in boards.items()
    }
    looks = {name: one.looks for name, one in spelt.items() if one.looks}
    processes = ask.processes if ask is not None else 1
    joined = joining.joined(looks, keys, processes=processes)
    readings = []
    for name in names:
        heard, seen = spelt.get(name), joined.get(name)
        own, rows = named(name), listed(name)
        own = rows[0] if rows and own == rows[0] else own  # which is held once
        spoiled = heard is not None and heard.spoiled
        told = {"why": why_silent(heard), "spoiled": spoiled}
        judged = placard.judge(own, rows, seen, **told)
        key = heard.key if heard else ""
        readings.append(Reading(name, judged, own, rows, seen, key))
    return Hearing(readings, boards)


def respelt(heard: Heard, board: str) -> Heard:
    """Spell what was read of a board by a profile's pattern of boards."""
    looks = placard.respelt(heard.looks, board)
    if not heard.looks or any(look.lines for look in looks):
        return replace(heard, looks=looks)
    why = "nothing on its board is as board.pattern in the profile has it"
    return replace(heard, looks=(), why=why)


def why_silent(heard: Heard | None) -> str:
    """Tell why a board that was looked for says nothing."""
    if heard is None:
        return ""
    return heard.why or ("no figures on its board" if heard.found else "no board found")


def pictured(store: Store, hearing: Hearing) -> list[Reading]:
    """Keep the pictures of boards that a person is to look at, and name them."""
    done = []
    for one in hearing.readings:
        seen, crop = hearing.boards.get(one.photo), ""
        if seen is not None and one.judged.verdict in TO_MEND:
            data = seen.picture()
            if data:
                crop = f"{FOLDER}/{one.key}.png"
                store.write_bytes(crop, data)
        done.append(one.shown(crop) if crop else one)
    return done


def listed_keys(photo: str, rows: Sequence[Entry]) -> tuple[Key, ...]:
    """Tell which keys the rows say that name a photograph; its name leads to others."""
    own = [one for one in rows if one.photo and stem(one.photo) == stem(photo)]
    return tuple(dict.fromkeys((one.block, one.lot) for one in own))


def placed(
    hearing: Hearing,
    shown: dict[str, tuple[Entry, ...]],
    strangers: Sequence[Rejection],
    entries: Sequence[Entry],
) -> tuple[dict[str, tuple[Entry, ...]], list[Rejection]]:
    """Give photographs that their board alone places the rows of their lot."""
    by_board = {
        one.photo: one.judged.key
        for one in hearing.readings
        if one.judged.verdict == "board" and one.judged.key is not None
    }
    of_lot: dict[Key, list[Entry]] = {key: [] for key in by_board.values()}
    for entry in entries:
        if (entry.block, entry.lot) in of_lot:
            of_lot[entry.block, entry.lot].append(entry)
    more = {photo: tuple(of_lot[key]) for photo, key in by_board.items()}
    looked = {one.photo: one for one in hearing.readings if one.photo in hearing.boards}
    left = [why(one, looked.get(one.key)) for one in strangers if one.key not in more]
    return shown | more, left


def why(one: Rejection, reading: Reading | None) -> Rejection:
    """Tell what the board says of a photograph that the list does not have."""
    if reading is None or reading.judged.verdict not in TO_MEND:
        return one
    unsure = reading.judged.verdict == "unsure"
    reason = "board not sure" if unsure else "no board that can be read"
    return Rejection(one.key, "placard", reason, reading.judged.remedy)
