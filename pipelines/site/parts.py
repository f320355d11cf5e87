"""What a site tells of its city, in parts: no reader needs more than what it looks at.

    site.json                       a header a block, and what is told of the city
    records/<block>-<sha8>.json     all that is known of a block's buildings
    finder/<number>-<sha8>.json     ids, lots and addresses of `LISTED` buildings or few
                                    more, to search in; blocks in the city's order

A building's block is told by its id, which begins with the block's name and a dash; the
few that do not are listed in site.json (`elsewhere`). So a link needs one record, the
finder its lists, and what leads through the city the `tour` that site.json tells.
"""

import json
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

from pipelines.site.aside import Aside
from pipelines.site.naming import digest, safe

LISTED: Final = 16_384  # buildings of a list: some 0.7 MB
CREDITED: Final = 3  # names: a page has room for two, and says that there are more
STOPS: Final = 12  # of a tour
WIDEST_M: Final = 40.0  # greater fronts count no more in a tour
HIGHEST_M: Final = 60.0

Json = dict[str, Any]


class Parts:
    """The parts of a city, made block by block; what is made lies aside."""

    def __init__(self, aside: Aside) -> None:
        """Begin with none."""
        self._aside = aside
        self.files: dict[str, Callable[[], bytes]] = {}
        self.blocks: list[Json] = []  # headers
        self._credits: Counter[str] = Counter()
        self._tour: list[Json] = []
        self._elsewhere: dict[str, str] = {}
        self._lists: list[str] = []
        self._list: list[Any] = []
        self._listed = 0

    def add(self, told: Mapping[str, Any], header: Json) -> None:
        """Add a block: its record, with its photos' files, and more for its header."""
        name, own = header["name"], told["buildings"]
        data = text({"block": told["block"], "buildings": own})
        file = f"records/{safe(name)}-{digest(data)}.json"
        self.files[file] = self._aside.put(data)
        kept = {key: value for key, value in told.items() if key != "buildings"}
        self.blocks.append({**kept, **header, "buildings": len(own), "record": file})
        for one in own:
            self._credits.update(c for p in one["photos"] if (c := p.get("credit")))
            if not str(one["id"]).startswith(f"{name}-"):
                self._elsewhere[str(one["id"])] = name
        stops = [*self._tour, *(stop(one, name, told) for one in own)]
        known = [one for one in stops if one["worth"] > 0 and one["at_m"]]
        self._tour = sorted(known, key=lambda one: (-one["worth"], one["id"]))[:STOPS]
        self._list.append([name, [row(one) for one in own]])
        self._listed += len(own)
        if self._listed >= LISTED:
            self._end_list()

    def close(self) -> Json:
        """Tell of the whole city, now that all its blocks are there."""
        self._end_list()
        often = [name for name, _ in self._credits.most_common(CREDITED)]
        told = {"credits": often, "tour": self._tour, "finder": self._lists}
        odd = {"elsewhere": self._elsewhere} if self._elsewhere else {}
        return {**told, **odd, "blocks": self.blocks}

    def _end_list(self) -> None:
        if not self._list:
            return
        data = text(self._list)
        name = f"finder/{len(self._lists) + 1}-{digest(data)}.json"
        self.files[name] = self._aside.put(data)
        self._lists.append(name)
        self._list, self._listed = [], 0


def row(building: Mapping[str, Any]) -> list[str]:
    """Tell what one searches a building by."""
    return [
        str(building["id"]),
        *(str(building.get(n, "")) for n in ("lot", "address")),
    ]


def stop(building: Mapping[str, Any], block: str, told: Mapping[str, Any]) -> Json:
    """Make a stop of a tour of a building: where it stands, and what it is worth."""
    name = building.get("address") or f"Lot {building.get('lot', building['id'])}"
    known = {"id": str(building["id"]), "name": name, "block": block}
    return {**known, "worth": round(worth(building), 4), "at_m": place(building, told)}


def worth(building: Mapping[str, Any]) -> float:
    """Tell how much a building has to show.

    That is photographed square metres, great ones counted less, where the site has a
    picture of the photograph that it wears.
    """
    photos = building["photos"]
    seen = any(one.get("used") and one.get("file") for one in photos)
    if building.get("assumed") or not seen:
        return 0.0
    share, width, height = (
        float(building.get(name) or 0.0)
        for name in ("photographed_share", "width_m", "height_m")
    )
    return share**2 * (min(width, WIDEST_M) * min(height, HIGHEST_M)) ** 0.5


def place(
    building: Mapping[str, Any], told: Mapping[str, Any]
) -> Sequence[float] | None:
    """Tell where a building stands in its block's frame, as far as that is known."""
    if building.get("footprint_m"):
        start, end = building["footprint_m"][:2]
        return [round((a + b) / 2, 3) for a, b in zip(start, end, strict=True)]
    return next((one[0] for one in told.get("outline_m", ()) if one), None)


def text(value: Any) -> bytes:
    """Write a value as JSON, on one line."""
    return json.dumps(value, ensure_ascii=False, allow_nan=False).encode()
