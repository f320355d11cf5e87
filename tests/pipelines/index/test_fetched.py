"""IIIF sources, served by a real server on this machine."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from pipelines.index import fetched, iiif, lists, manifest, web
from pipelines.index.images import Nothing
from pipelines.index.index import index
from pipelines.store import Store
from tests.pipelines import painted
from tests.pipelines.index.served import (
    Answer,
    Server,
    busy,
    endless,
    gives,
    leads,
    served,
    trickling,
)

QUICK = web.Patience(connect_s=1, silent_s=1, whole_s=3, pause_s=0.001)
CC0 = "http://creativecommons.org/publicdomain/zero/1.0/"


@pytest.fixture
def server() -> Iterator[Server]:
    with served() as one:
        yield one


def level_2(url: str, w: int = 640, h: int = 480) -> dict[str, Any]:
    return {
        "@context": "http://iiif.io/api/image/3/context.json",
        "id": url,
        "type": "ImageService3",
        "profile": "level2",
        "width": w,
        "height": h,
    }


def third(server: Server, *labels: str, **more: Any) -> dict[str, Any]:
    """Write a manifest of 3.0, and let the server give its pictures."""
    canvases = []
    for number, label in enumerate(labels):
        at = f"{server.url}/image/{number}"
        server.answers[f"/image/{number}/info.json"] = gives(
            json.dumps(level_2(at)).encode()
        )
        picture = gives(painted.photo(number), "image/png")
        server.answers[f"/image/{number}/full/max/0/default.jpg"] = picture
        body = {"id": f"{at}/full/max/0/default.jpg", "type": "Image"}
        body |= {"service": [{"id": at, "type": "ImageService3", "profile": "level2"}]}
        annotation = {"type": "Annotation", "motivation": "painting", "body": body}
        canvases.append(
            {
                "id": f"{server.url}/canvas/{number}",
                "type": "Canvas",
                "label": {"en": [label]},
                "items": [{"type": "AnnotationPage", "items": [annotation]}],
            }
        )
    return {
        "@context": "http://iiif.io/api/presentation/3/context.json",
        "id": f"{server.url}/manifest.json",
        "type": "Manifest",
        "label": {"en": ["Elm Street"]},
        "rights": CC0,
        "requiredStatement": {
            "label": {"en": ["Attribution"]},
            "value": {"en": ["<b>An Archive</b>"]},
        },
        "metadata": [{"label": {"en": ["Date"]}, "value": {"none": ["1939-1941"]}}],
        "items": canvases,
    } | more


def second(server: Server, *labels: str) -> dict[str, Any]:
    """Write the same as a manifest of 2.1, whose pictures have no image server."""
    canvases = []
    for number, label in enumerate(labels):
        where = f"/picture/{number}.png"
        server.answers[where] = gives(painted.photo(number), "image/png")
        resource = {"@id": f"{server.url}{where}", "@type": "dctypes:Image"}
        image = {"motivation": "sc:painting", "resource": resource}
        one = {"@id": f"{server.url}/c{number}", "@type": "sc:Canvas", "label": label}
        canvases.append(one | {"images": [image]})
    return {
        "@context": "http://iiif.io/api/presentation/2/context.json",
        "@id": f"{server.url}/manifest.json",
        "@type": "sc:Manifest",
        "label": "Elm Street",
        "license": CC0,
        "attribution": {"@value": "An Archive", "@language": "en"},
        "metadata": [{"label": "Date", "value": "1939-1941"}],
        "sequences": [{"canvases": canvases}],
    }


def put(server: Server, document: dict[str, Any], path: str = "/manifest.json") -> str:
    server.answers[path] = gives(json.dumps(document).encode())
    return f"{server.url}{path}"


def rows(city: Path) -> list[manifest.Row]:
    return list(manifest.read(Store(str(city))).rows)


@pytest.mark.parametrize("make", [second, third])
def test_both_versions_make_the_same_manifest(
    make: Any, server: Server, tmp_path: Path
) -> None:
    url = put(server, make(server, "993-1", "993-2"))
    made = index(url, None, str(tmp_path / "city"))
    assert (made.photos, made.without_front) == (2, ())
    told = [
        (r.front and (r.front.block, r.front.lot), r.credit)
        for r in rows(tmp_path / "city")
    ]
    assert told == [(("993", "1"), "An Archive"), (("993", "2"), "An Archive")]
    expected = {"license": CC0, "date": "1939/1941"}
    assert all(row.told == expected for row in rows(tmp_path / "city"))
    brought = (tmp_path / "city" / "photographs" / "993-1.png").read_bytes()
    assert brought == painted.photo(0)


def test_a_second_run_asks_nothing(server: Server, tmp_path: Path) -> None:
    url, city = put(server, third(server, "993-1", "993-2")), tmp_path / "city"
    index(url, None, str(city))
    before = {p.name: p.read_bytes() for p in city.iterdir() if p.is_file()}
    asked = len(server.asked)
    server.answers.clear()
    index(url, None, str(city))
    assert len(server.asked) == asked
    assert {p.name: p.read_bytes() for p in city.iterdir() if p.is_file()} == before


def test_one_request_at_a_time(server: Server, tmp_path: Path) -> None:
    index(put(server, third(server, "ab1", "cd2", "ef3")), None, str(tmp_path))
    assert len(server.asked) == 7
    assert server.most_at_once == 1


def test_a_collection_is_followed_once_round(server: Server, tmp_path: Path) -> None:
    one, two = third(server, "993-1"), third(server, "993-2")
    urls = [put(server, one, "/1"), put(server, two, "/2")]
    inner = {"id": f"{server.url}/inner", "type": "Collection"}
    top = {"id": f"{server.url}/top", "type": "Collection", "label": {"en": ["All"]}}
    both = [{"id": url, "type": "Manifest"} for url in urls]
    put(server, inner | {"items": [*both[1:], top]}, "/inner")
    made = index(
        put(server, top | {"items": [*both[:1], inner]}, "/top"), None, str(tmp_path)
    )
    assert made.photos == 2
    assert sorted(r.photo for r in rows(tmp_path)) == ["993-1.png", "993-2.png"]


def test_a_busy_server_is_asked_again(server: Server) -> None:
    server.answers["/x"] = busy(3, gives(b"{}"))
    assert web.fetch(f"{server.url}/x", 10, patience=QUICK) == b"{}"
    assert server.asked == ["/x"] * 4


HOSTILE: dict[str, tuple[Any, str]] = {
    "nothing": (gives(b"", "text/plain", 404), "404"),
    "a page": (gives(b"<html></html>", "text/html"), "page for people"),
    "always busy": (busy(99, gives(b"{}")), "503"),
    "endless": (endless, "larger than"),
    "a file": (leads("file:///etc/passwd"), "no address on the web"),
    "round and round": (leads("/x"), "redirects"),
    "a port of nobody": (leads("ftp://127.0.0.1/x"), "no address on the web"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_server_is_told_in_words(name: str, server: Server) -> None:
    answer, said = HOSTILE[name]
    server.answers["/x"] = answer
    with pytest.raises(web.Unfetched, match=said):
        web.fetch(f"{server.url}/x", 1_000_000, patience=QUICK)


def test_a_server_that_trickles_is_left(server: Server) -> None:
    server.answers["/x"] = trickling(server.ended)
    with pytest.raises(web.Unfetched, match="within 3 seconds"):
        web.fetch(f"{server.url}/x", 1_000_000, patience=QUICK)


def test_a_large_answer_is_refused_before_it_is_read(server: Server) -> None:
    server.answers["/x"] = gives(bytes(1001), "application/json")
    with pytest.raises(web.Unfetched, match="larger than the 1,000"):
        web.fetch(f"{server.url}/x", 1000, patience=QUICK)
    assert web.fetch(f"{server.url}/x", 1001, patience=QUICK) == bytes(1001)


def test_the_web_does_not_lead_into_this_machine_s_own_network() -> None:
    public, ours = "http://93.184.216.34/m", "http://127.0.0.1:9/x"
    with pytest.raises(web.Unfetched, match="own network"):
        web.allowed(ours, public)
    web.allowed(ours, ours)
    web.allowed(public, public)


@pytest.mark.parametrize(
    "answer", [gives(b"<html>", "image/jpeg"), gives(b"", "text/plain", 404)]
)
def test_a_photograph_that_is_none_spoils_no_other(
    answer: Answer, server: Server, tmp_path: Path
) -> None:
    url = put(server, third(server, "993-1", "993-2"))
    server.answers["/image/1/full/max/0/default.jpg"] = answer
    made = index(url, None, str(tmp_path))
    assert made.photos == 1
    (rejection,) = made.rejections
    assert (rejection.key, rejection.reason) == ("993-2", "not brought")


def test_a_dead_server_is_given_up(server: Server, tmp_path: Path) -> None:
    document = third(server, *(f"993-{n}" for n in range(1, 12)))
    url = put(server, document)
    server.answers = {"/manifest.json": server.answers["/manifest.json"]}
    with pytest.raises(Nothing, match="gives no photograph"):
        index(url, None, str(tmp_path))
    assert sum("default.jpg" in path for path in server.asked) == fetched.GIVE_UP


@pytest.mark.parametrize(
    "data", [b"", b"<html>", b"[]", b"{}", b'{"type":"Manifest"}', b"[" * 100_000]
)
def test_what_is_no_manifest_is_told(
    data: bytes, server: Server, tmp_path: Path
) -> None:
    server.answers["/m"] = gives(data)
    with pytest.raises(Nothing, match="/m"):
        index(f"{server.url}/m", None, str(tmp_path))


def test_a_list_tells_where_and_the_manifest_whose(
    server: Server, tmp_path: Path
) -> None:
    url = put(server, third(server, "plate 1", "plate 2"))
    listed = tmp_path / "list.csv"
    listed.write_text("photo,block,lot\nplate_1,7,3\nplate_2,7,5\n")
    index(url, listed, str(tmp_path / "city"))
    found = [(r.front and r.front.lot, r.told) for r in rows(tmp_path / "city")]
    whose = {"license": CC0, "date": "1939/1941"}
    assert found == [("3", whose), ("5", whose)]


def test_without_keys_photographs_stand_in_the_manifest_s_order(
    server: Server, tmp_path: Path
) -> None:
    labels = ["view B 1", "view A 1", "view C 1"]
    source = tmp_path / "elm.json"
    source.write_text(json.dumps(third(server, *labels)))
    index(source, None, str(tmp_path / "city"))
    found = sorted(
        rows(tmp_path / "city"), key=lambda r: int(r.front.lot if r.front else 0)
    )
    assert [r.photo for r in found] == [f"{x.replace(' ', '_')}.png" for x in labels]


@pytest.mark.parametrize("longest", [100, 640, 4096])
@pytest.mark.parametrize("w", [90, 640, 9000])
def test_no_larger_picture_is_asked_for_than_is_of_use(w: int, longest: int) -> None:
    info = iiif.Info.model_validate(level_2("https://x", w, w // 2))
    size = iiif.request("https://x/", info, longest_px=longest).split("/")[4]
    assert size == ("max" if w <= longest else f"{longest},{longest // 2}")


def test_a_server_of_level_0_is_asked_for_what_it_has() -> None:
    sizes = [{"width": w, "height": w // 2} for w in (100, 400, 5000)]
    told = level_2("https://x", 5000, 2500) | {"profile": "level0", "sizes": sizes}
    info = iiif.Info.model_validate(told)
    assert iiif.request("https://x", info) == "https://x/full/400,200/0/default.jpg"


def test_a_server_of_the_second_version_is_asked_in_its_words() -> None:
    context = "http://iiif.io/api/image/2/context.json"
    told = {"@context": context, "width": 640, "height": 480, "profile": []}
    info = iiif.Info.model_validate(told)
    assert iiif.request("https://x", info).endswith("/full/full/0/default.jpg")
    small = iiif.request("https://x", info, longest_px=64)
    assert small.endswith("/full/64,/0/default.jpg")


def test_a_city_elsewhere_takes_no_photographs() -> None:
    with pytest.raises(Nothing, match="not on this machine"):
        lists.opened("https://example.org/m.json", None, "s3://bucket/city")
