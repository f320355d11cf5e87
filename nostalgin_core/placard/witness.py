"""Three witnesses of where a photograph belongs: its name, its list, its board.

None outvotes another in silence. Where two tell the same the photograph's place is
agreed; where they contradict, all are told, and what was believed before boards were
read stays: the list's row, else the file's name.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from nostalgin_core.placard.joined import Joined
from nostalgin_core.placard.misread import Key

Verdict = Literal["agreed", "name", "list", "board", "contradicted", "unsure", "silent"]
VERDICTS: Final[tuple[Verdict, ...]] = (
    "agreed",
    "name",
    "list",
    "board",
    "contradicted",
    "unsure",
    "silent",
)
ROW: Final = "add a row with the photograph's name, block and lot to the list"


@dataclass(frozen=True, slots=True)
class Judged:
    """What the witnesses say together."""

    verdict: Verdict
    key: Key | None  # where the photograph is put
    remedy: str = ""


def judge(
    name: Key | None,
    listed: Sequence[Key],
    board: Joined | None,
    *,
    why: str = "",
    spoiled: bool = False,
) -> Judged:
    """Hear a photograph's file name, the rows that name it, and its board.

    `why` tells why no board was read of which one was wanted; of a photograph that is
    `spoiled` it is what is to be mended first.
    """
    seen = board.key if board is not None and board.sure else None
    told = {
        "its name": [name] if name else [],
        "the list": list(dict.fromkeys(listed)),
        "its board": [seen] if seen else [],
    }
    before = [*told["the list"], *told["its name"]]
    key = before[0] if before else seen
    speak = {who: keys for who, keys in told.items() if keys}
    if not speak:
        return silent(board, why, spoiled=spoiled)
    if not set.intersection(*map(set, speak.values())):
        said = "; ".join(f"{who} says {spelled(keys)}" for who, keys in speak.items())
        remedy = f"{said}: look at the picture, and mend the wrong one"
        return Judged("contradicted", key, remedy)
    if len(speak) > 1:
        return Judged("agreed", key)
    alone: dict[str, Verdict] = {
        "its name": "name",
        "the list": "list",
        "its board": "board",
    }
    return Judged(alone[next(iter(speak))], key)


def silent(board: Joined | None, why: str, *, spoiled: bool = False) -> Judged:
    """Tell what is to be done about a photograph that nothing places for sure."""
    if spoiled:
        return Judged("silent", None, why)
    if board is None or not board.text:
        return Judged("silent", None, f"{why}: {ROW}" if why else ROW)
    if board.key is not None and not board.listed:
        off = f"its board says {spelled([board.key])}, which is not on the list"
        return Judged("unsure", None, f"{off}: add that lot to the list, or {ROW}")
    nearest = [one for one in (board.key, board.runner_up) if one is not None]
    between = f", perhaps {' or '.join(map('-'.join, nearest))}" if nearest else ""
    unsure = f"its board says {board.text!r}{between}"
    return Judged("unsure", None, f"{unsure}: look at the picture, and {ROW}")


def spelled(keys: Sequence[Key]) -> str:
    """Write keys for people."""
    return ", ".join("-".join(key) for key in keys)
