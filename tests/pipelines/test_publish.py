import hashlib
import json
from pathlib import Path

import pytest

from pipelines import publish, view
from pipelines.site.folder import RECORD, Folder, Foreign

FILES = {
    "index.html": b"<!doctype html>",
    "assets/index-1.js": b"1",
    "blocks/1-ab.glb": b"glTF",
    "site.json": b"{}",
    "tileset.json": b"{}",
}


def built(city: Path, files: dict[str, bytes]) -> Path:
    site = Folder(city / "site", files)
    for name, data in files.items():
        site.write(name, data)
    site.prune()
    return city


def there(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file() and path.name != RECORD
    }


@pytest.fixture
def city(tmp_path: Path) -> Path:
    return built(tmp_path / "city", FILES)


def test_a_copy_is_the_site_and_can_be_served(city: Path, tmp_path: Path) -> None:
    done = publish.publish(city, tmp_path / "deep" / "public")
    assert there(done.folder) == FILES
    assert (done.files, done.size) == (5, sum(map(len, FILES.values())))
    assert view.site_of(done.folder) == done.folder.resolve()
    assert [p.name for p in (tmp_path / "deep").iterdir()] == ["public"]


def test_only_what_the_present_city_needs_is_copied(city: Path, tmp_path: Path) -> None:
    anew = {n: d for n, d in FILES.items() if "glb" not in n} | {"blocks/2.glb": b"2"}
    built(city, anew)
    assert "blocks/1-ab.glb" in there(city / "site")  # for who reads the city before
    publish.publish(city, tmp_path / "public")
    assert there(tmp_path / "public") == anew


def test_publishing_again_replaces_and_keeps_for_readers(
    city: Path, tmp_path: Path
) -> None:
    public = tmp_path / "public"
    publish.publish(city, public)
    built(city, {**FILES, "site.json": b'{"a": 1}'})
    publish.publish(city, public)
    assert json.loads((public / "site.json").read_text()) == {"a": 1}
    assert (public / "blocks/1-ab.glb").exists()


def test_what_is_another_s_is_never_touched(city: Path, tmp_path: Path) -> None:
    public = tmp_path / "public"
    public.mkdir()
    (public / "mine.txt").write_text("mine")
    with pytest.raises(Foreign, match="publish again"):
        publish.publish(city, public)
    assert there(public) == {"mine.txt": b"mine"}


def test_a_strangers_file_beside_ours_stays(city: Path, tmp_path: Path) -> None:
    public = tmp_path / "public"
    publish.publish(city, public)
    (public / "CNAME").write_text("example.org")
    publish.publish(city, public)
    publish.publish(city, public)
    assert (public / "CNAME").read_text() == "example.org"


@pytest.mark.parametrize("name", ["site", "site/inside", "."])
def test_the_city_is_not_published_into_itself(city: Path, name: str) -> None:
    before = there(city)
    with pytest.raises(Foreign, match="outside"):
        publish.publish(city, city / name)
    assert there(city) == before


def test_a_link_is_not_followed(city: Path, tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "public").symlink_to(tmp_path / "real")
    with pytest.raises(Foreign, match="link"):
        publish.publish(city, tmp_path / "public")
    assert there(tmp_path / "real") == {}


def test_a_site_with_a_hole_is_not_published(city: Path, tmp_path: Path) -> None:
    (city / "site/blocks/1-ab.glb").unlink()
    with pytest.raises(Foreign, match="is gone"):
        publish.publish(city, tmp_path / "public")
    assert not (tmp_path / "public").exists()


def test_what_names_other_files_comes_last() -> None:
    assert publish.ordered(FILES)[-3:] == list(publish.LAST)


def test_a_record_that_is_damaged_is_named_and_nothing_changes_for_visitors(
    city: Path, tmp_path: Path
) -> None:
    data = b'{"buildings": []}'
    name = f"records/1-{hashlib.sha256(data).hexdigest()[:8]}.json"
    built(city, {**FILES, name: data})
    public = tmp_path / "public"
    publish.publish(city, public)
    before = there(public)
    assert before[name] == data
    (city / "site" / name).write_bytes(data[:5])
    for folder in (public, tmp_path / "new"):
        with pytest.raises(Foreign, match=rf"{name} is damaged: run `nostalgin build`"):
            publish.publish(city, folder)
    assert there(public) == before
    assert not (tmp_path / "new").exists()
