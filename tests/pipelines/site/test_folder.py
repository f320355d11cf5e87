import json
import os
import tracemalloc
from collections.abc import Iterator
from pathlib import Path

import pytest

from pipelines.site import folder as room
from pipelines.site.folder import RECORD, Folder, Foreign, lines, written

NAMES = ("index.html", "blocks/1.glb", "photos/a.webp")


def publish(root: Path, names: tuple[str, ...] = NAMES, *, most: int = 99) -> None:
    """Write files that say their own names; stop before the end like a killed one."""
    folder = Folder(root, names)
    for name in names[:most]:
        folder.write(name, name.encode())
    if most >= len(names):
        folder.prune()


def files(root: Path) -> dict[str, bytes]:
    return {
        path.relative_to(root).as_posix(): path.read_bytes()
        for path in sorted(root.rglob("*"))
        if path.is_file()
    }


def test_what_is_left_are_the_files_that_were_asked_for(tmp_path: Path) -> None:
    publish(tmp_path / "site", (*NAMES, "blocks/0.glb"))
    publish(tmp_path / "site")
    assert set(files(tmp_path / "site")) == {RECORD, *NAMES, "blocks/0.glb"}
    publish(tmp_path / "site")
    assert set(files(tmp_path / "site")) == {RECORD, *NAMES}
    assert written(tmp_path / "site") == set(NAMES)


def test_strangers_files_stay(tmp_path: Path) -> None:
    publish(tmp_path / "site")
    strangers = ("CNAME", "photos/original.jpg", "blocks/mine/deep.glb")
    for name in strangers:
        (tmp_path / "site" / name).parent.mkdir(exist_ok=True)
        (tmp_path / "site" / name).write_text("mine")
    for _ in range(2):
        publish(tmp_path / "site", ("index.html",))
    assert set(files(tmp_path / "site")) == {RECORD, "index.html", *strangers}


def test_a_folder_of_another_is_refused_and_left_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "site/photos").mkdir(parents=True)
    (tmp_path / "site/photos/original.jpg").write_text("mine")
    before = files(tmp_path)
    with pytest.raises(Foreign, match="move them elsewhere"):
        publish(tmp_path / "site")
    assert files(tmp_path) == before


def test_a_stranger_in_the_way_stops_all_before_anything_is_written(
    tmp_path: Path,
) -> None:
    publish(tmp_path / "site")
    (tmp_path / "site/blocks/2.glb").write_text("mine")
    before = files(tmp_path)
    with pytest.raises(Foreign, match=r"blocks/2\.glb"):
        publish(tmp_path / "site", (*NAMES, "blocks/2.glb"))
    assert files(tmp_path) == before


@pytest.mark.parametrize("linked", ["site", "site/photos"])
def test_no_link_is_followed(linked: str, tmp_path: Path) -> None:
    publish(tmp_path / "site")
    (tmp_path / linked).rename(tmp_path / "elsewhere")
    (tmp_path / linked).symlink_to(tmp_path / "elsewhere")
    before = files(tmp_path)
    with pytest.raises(Foreign, match="link"):
        publish(tmp_path / "site", (*NAMES, "photos/b.webp"))
    assert files(tmp_path) == before


def test_what_lies_behind_a_link_in_a_files_place_is_not_removed(
    tmp_path: Path,
) -> None:
    publish(tmp_path / "site")
    (tmp_path / "original").write_text("mine")
    (tmp_path / "site/photos/a.webp").unlink()
    (tmp_path / "site/photos/a.webp").symlink_to(tmp_path / "original")
    publish(tmp_path / "site", ("index.html",))
    assert (tmp_path / "original").read_text() == "mine"


@pytest.mark.parametrize("most", range(len(NAMES)))
def test_one_that_was_cut_off_is_gone_on_with(most: int, tmp_path: Path) -> None:
    publish(tmp_path / "site", most=most)
    (tmp_path / "site/.index.html.7.partial").write_text("half of")
    publish(tmp_path / "site")
    publish(tmp_path / "whole")
    assert files(tmp_path / "site") == files(tmp_path / "whole")


def test_one_that_was_cut_off_in_its_record_is_gone_on_with(tmp_path: Path) -> None:
    (tmp_path / "site").mkdir()
    (tmp_path / f"site/.{RECORD}.7.partial").write_text("half of")
    publish(tmp_path / "site")
    assert set(files(tmp_path / "site")) >= {RECORD, *NAMES}


def test_a_link_in_the_place_of_half_a_file_is_not_written_through(
    tmp_path: Path,
) -> None:
    publish(tmp_path / "site", ("blocks/1.glb",))
    (tmp_path / "original").write_text("mine")
    link = tmp_path / f"site/.index.html.{os.getpid()}.partial"
    link.symlink_to(tmp_path / "original")
    publish(tmp_path / "site")
    assert (tmp_path / "original").read_text() == "mine"
    assert not (tmp_path / "site/index.html").is_symlink()


@pytest.mark.parametrize(("place", "folder"), [("photos", False), ("new.html", True)])
def test_a_file_for_a_folder_or_a_folder_for_a_file_stops_all(
    place: str, tmp_path: Path, *, folder: bool
) -> None:
    publish(tmp_path / "site", ("index.html",))
    (tmp_path / "site" / place).mkdir() if folder else (
        tmp_path / "site" / place
    ).write_text("mine")
    before = files(tmp_path)
    with pytest.raises(Foreign, match=place):
        publish(tmp_path / "site", (*NAMES, "new.html"))
    assert files(tmp_path) == before


@pytest.mark.parametrize(
    "record", ["", "{}", "[1]", '["../original"]', '["/etc/passwd"]', '["a\\u0000"]']
)
def test_a_record_that_makes_no_sense_is_no_record(record: str, tmp_path: Path) -> None:
    publish(tmp_path / "site")
    (tmp_path / "original").write_text("mine")
    (tmp_path / "site" / RECORD).write_text(record)
    with pytest.raises(Foreign):
        publish(tmp_path / "site", ("index.html",))
    assert (tmp_path / "original").read_text() == "mine"


def test_a_file_that_was_not_announced_is_a_mistake(tmp_path: Path) -> None:
    with pytest.raises(KeyError):
        Folder(tmp_path / "site", NAMES).write("another", b"")
    told = json.loads((tmp_path / "site" / RECORD).read_bytes())
    assert told == {"now": [], "before": sorted(NAMES)}


@pytest.mark.parametrize("now", [[], ["a"], ['a"\n', "שלום", "\udc80"]])
@pytest.mark.parametrize("before", [[], ["a"], ["b", "c/d"]])
def test_a_record_is_what_one_json_text_of_it_would_be(
    now: list[str], before: list[str]
) -> None:
    told = {"now": now, "before": before}
    assert "".join(lines(now, before)) == json.dumps(told, indent=0)


def test_a_file_that_grows_is_there_whole_or_as_it_was(tmp_path: Path) -> None:
    publish(tmp_path / "site")
    before = files(tmp_path / "site")
    path = tmp_path / "site/index.html"
    written_at = path.stat().st_mtime_ns
    site = Folder(tmp_path / "site", NAMES)
    with pytest.raises(TypeError), site.growing("index.html") as file:
        file.writelines([b"half of", None])  # type: ignore[list-item]
    with site.growing("index.html") as file:
        file.writelines((b"index", b".html"))
    site.prune()
    assert files(tmp_path / "site") == before
    assert path.stat().st_mtime_ns == written_at
    with site.growing("index.html") as file:
        file.write(b"index.htmX")
    assert path.read_bytes() == b"index.htmX"
    with pytest.raises(KeyError):
        site.growing("another")


def small(count: int) -> Iterator[str]:
    return (f"photos/{number:016x}.webp" for number in range(count))


def test_a_name_is_held_once_however_often_it_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(room.Folder, "_free", lambda *_: None)  # no file is there yet
    count, held = 20_000, []
    for _ in range(3):
        tracemalloc.start()
        try:
            site = Folder(tmp_path / "site", small(count))
            held.append([each / count for each in tracemalloc.get_traced_memory()])
        finally:
            tracemalloc.stop()
        del site
        with monkeypatch.context() as only:  # of prune, its record
            only.setattr(Path, "glob", lambda *_: ())
            Folder(tmp_path / "site", small(count)).prune()
    (first, _), *later = held
    for now, most in later:
        assert now == pytest.approx(first, rel=0.25)  # 3.2 where held twice
        assert most < 3 * first  # as above, 6
