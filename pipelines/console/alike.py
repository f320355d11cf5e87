"""Things that were rejected alike become one line, with their count and first names."""

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any, Final

MOST_NAMES: Final = 8  # of those that were rejected alike


def folded(rejections: Iterable[Mapping[str, Any]]) -> list[str]:
    """Write a line a cause: whom it met, and why; in the order of the first met.

    What names itself in its detail is alike but for its name.
    """
    alike: dict[tuple[str, ...], list[Mapping[str, Any]]] = {}
    count: Counter[tuple[str, ...]] = Counter()
    for one in rejections:
        key = one["key"]
        detail = one["detail"].replace(key, "it") if key else one["detail"]
        why = (one.get("stage", ""), one["reason"], detail)
        count[why] += 1
        if count[why] <= MOST_NAMES:
            alike.setdefault(why, []).append(one)
    lines = []
    for (stage, reason, detail), some in alike.items():
        names, whole = ", ".join(x["key"] for x in some), count[stage, reason, detail]
        if whole > MOST_NAMES:
            names = f"{whole} ({names} ...)"
        words = some[0]["detail"] if whole == 1 else detail
        why = ": ".join(filter(None, (stage, reason, words)))
        lines.append(f"{names}: {why}")
    return lines
