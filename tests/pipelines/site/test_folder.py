import json
import os
from pathlib import Path

import pytest

from pipelines.site.folder import RECORD, Folder, Foreign, written

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
