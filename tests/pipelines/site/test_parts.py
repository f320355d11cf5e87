"""A site in parts tells what one file told, and no part grows with the city."""

import json
from itertools import permutations
from pathlib import Path
from typing import Any

import pytest

from pipelines.site import parts
from pipelines.site.aside import Aside, Heaps
from pipelines.site.naming import altered
from pipelines.site.parts import Parts, worth

SEEN = {
    "photos": [{"key": "a", "used": True, "file": "photos/a.webp", "credit": "A"}],
    "photographed_share": 0.9,
    "width_m": 10.0,
    "height_m": 15.0,
    "footprint_m": [[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]],
}


def building(name: str, **more: Any) -> dict[str, Any]:
    return SEEN | {"id": name, "lot": name.rpartition("-")[2], "address": ""} | more


def told(block: str, *buildings: dict[str, Any]) -> dict[str, Any]:
    outline = [[[0.0, 0.0], [20.0, 0.0], [20.0, 9.0]]]
    return {"block": block, "outline_m": outline, "buildings": list(buildings)}


def made(
    folder: Path, *blocks: dict[str, Any]
) -> tuple[dict[str, Any], dict[str, bytes]]:
    with Aside(folder) as aside:
        own = Parts(aside)
        for one in blocks:
            own.add(one, {"name": one["block"], "uri": "u", "coarse": ""})
        city = own.close()
        return city, {name: read() for name, read in own.files.items()}


def city_of(count: int, each: int = 3) -> list[dict[str, Any]]:
    return [
        told(f"{n:04}", *(building(f"{n:04}-{lot}") for lot in range(each)))
        for n in range(count)
    ]


def test_each_building_stands_in_one_record_and_in_one_list(tmp_path: Path) -> None:
    blocks = city_of(40)
    city, files = made(tmp_path, *blocks)
    for one, header in zip(blocks, city["blocks"], strict=True):
        record = json.loads(files[header["record"]])
        assert record == {"block": one["block"], "buildings": one["buildings"]}
        assert header["buildings"] == 3
    rows = [one for name in city["finder"] for one in json.loads(files[name])]
    ids = [id_ for _, own in rows for id_, _, _ in own]
    assert ids == [one["id"] for block in blocks for one in block["buildings"]]


def test_what_is_read_first_grows_with_blocks_and_not_with_their_buildings(
    tmp_path: Path,
) -> None:
    few, many = (
        len(json.dumps(made(tmp_path, *city_of(30, each))[0])) for each in (4, 9)
    )
    more = len(json.dumps(made(tmp_path, *city_of(60, 4))[0]))
    assert few == many
    assert 1.8 < more / few < 2.2


def test_lists_are_few_and_hold_whole_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(parts, "LISTED", 10)
    city, files = made(tmp_path, *city_of(30))
    lists = [json.loads(files[name]) for name in city["finder"]]
    assert [len(one) for one in lists] == [4] * 7 + [2]


def test_parts_are_named_by_their_content(tmp_path: Path) -> None:
    city, files = made(tmp_path, *city_of(3))
    for name, data in files.items():
        assert not altered(name, data)
        assert altered(name, data + b" ")
    changed = city_of(3)
    changed[1]["buildings"][0]["address"] = "5 Elm Street"
    later, _ = made(tmp_path, *changed)
    same = [
        a["record"] == b["record"]
        for a, b in zip(city["blocks"], later["blocks"], strict=True)
    ]
    assert same == [True, False, True]
    assert not altered("index.html", b"whatever")


def test_a_block_of_any_name_has_a_harmless_record(tmp_path: Path) -> None:
    names = ["../../up", "/etc/x", "a\0b", "", "..", "C:\\x", "a/b", "a-b"]
    _, files = made(tmp_path, *(told(one, building(f"{one}-1")) for one in names))
    records = [name for name in files if name.startswith("records/")]
    assert len(records) == len(names)
    assert all(one.count("/") == 1 and ".." not in one for one in records)


def test_an_id_that_does_not_tell_its_block_is_told_apart(tmp_path: Path) -> None:
    own = [building("7-1"), building("7-1-2"), building("corner"), building("70-1")]
    city, _ = made(tmp_path, told("7", *own), told("70", building("70-2")))
    assert city["elsewhere"] == {"corner": "7", "70-1": "7"}
    assert "elsewhere" not in made(tmp_path, *city_of(5))[0]


def test_those_named_most_often_are_credited_first_and_no_more_than_are_shown(
    tmp_path: Path,
) -> None:
    named = ["A", "B", "B", "", "C", "C", "C", "D", "E"]
    photos = [{"key": str(n), "credit": one} for n, one in enumerate(named)]
    city, _ = made(tmp_path, told("1", building("1-1", photos=photos)))
    assert city["credits"] == ["C", "B", "A"]


def test_what_nobody_photographed_is_not_worth_a_stop() -> None:
    one = building("1-1")
    assert worth(one | {"assumed": True}) == 0
    assert worth(one | {"photos": []}) == 0
    for lacking in ({"used": False}, {"file": None}):
        assert worth(one | {"photos": [SEEN["photos"][0] | lacking]}) == 0
    assert worth(one) > worth(one | {"photographed_share": 0.5}) > 0
    assert worth(one | {"height_m": 30.0}) > worth(one)
    assert worth(one | {"width_m": 400.0}) == worth(one | {"width_m": 40.0})


def test_a_tour_leads_to_the_best_whatever_the_order_of_blocks(tmp_path: Path) -> None:
    shares = [0.9, 0.2, 0.8, 0.5]
    blocks = [
        told(
            str(n),
            *(building(f"{n}-{k}", photographed_share=s / k) for k in (1, 2, 3, 4)),
        )
        for n, s in enumerate(shares)
    ]
    tours = [made(tmp_path, *order)[0]["tour"] for order in permutations(blocks)]
    assert all(one == tours[0] for one in tours)
    assert len(tours[0]) == parts.STOPS
    assert tours[0][0] == {
        "id": "0-1",
        "name": "Lot 1",
        "block": "0",
        "worth": round(0.81 * 150**0.5, 4),
        "at_m": [5.0, 0.0],
    }


def test_what_is_set_aside_comes_back_and_leaves_no_name(tmp_path: Path) -> None:
    with Aside(tmp_path) as aside, Heaps(tmp_path, 3) as heaps:
        pieces = [bytes([n]) * n * 1000 for n in range(9)]
        held = [aside.put(one) for one in pieces]
        for n in range(100):
            heaps.put(f"name {n % 7}\udcff", {"n": n, "word": "\udcff é"})
        assert [read() for read in reversed(held)] == pieces[::-1]
        found = list(heaps.each())
        assert list(tmp_path.iterdir()) == []
    assert sorted(one["n"] for heap in found for one in heap) == list(range(100))
    for heap in found:
        numbers = [one["n"] for one in heap]
        assert numbers == sorted(numbers)
    own = [{one["n"] % 7 for one in heap} for heap in found]
    assert sum(map(len, own)) == 7  # those of one name lie in one heap
