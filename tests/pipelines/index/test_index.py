import csv
import io
import os
from pathlib import Path

import pytest

from pipelines.index import manifest
from pipelines.index.images import Nothing
from pipelines.index.index import Indexed, Question, index
from pipelines.index.profiles import USUAL, profile
from pipelines.index.roots import located
from pipelines.store.store import Store
from tests.data import DATA, needs_data
from tests.pipelines.hostile import hostile

CATALOGUE = """photo,block,lot,street,address,width_m,remark
b/993_1.jpg,993,1,First Street,1,10,
b/993_2.jpg,993,2,First Street,3,8,torn
,993,3,First Street,5,9,
b/994_1.jpg,994,1,Second Street,2,7,
"""


@pytest.fixture
def photos(tmp_path: Path) -> Path:
    folder = tmp_path / "photos"
    for name in ("b/993_1.jpg", "b/993_2.jpg", "b/994_1.jpg"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(b"x")
    (folder / "notes.txt").write_text("no photo")
    return folder


def indexed(
    photos: Path, text: str | None, question: Question | None = None
) -> Indexed:
    listed = photos.parent / "list.csv"
    if text is not None:
        listed.write_text(text, newline="")
    city = str(photos.parent / "city")
    asked = question or Question()
    return index(photos, listed if text is not None else None, city, asked)


def pairs(photos: Path) -> list[tuple[str, str | None]]:
    found = manifest.read(Store(str(photos.parent / "city")))
    return [(row.photo, row.front and row.front.lot) for row in found.rows]


def test_each_photo_gets_its_front_and_each_front_a_row(photos: Path) -> None:
    made = indexed(photos, CATALOGUE)
    assert (made.photos, made.fronts, made.blocks) == (3, 4, 2)
    assert sorted(pairs(photos)) == [
        ("", "3"),
        ("b/993_1.jpg", "1"),
        ("b/993_2.jpg", "2"),
        ("b/994_1.jpg", "1"),
    ]


def test_what_index_writes_build_reads_without_complaint(photos: Path) -> None:
    indexed(photos, CATALOGUE)
    found = manifest.read(Store(str(photos.parent / "city")))
    assert (found.rejections, found.warnings) == ((), ())


def test_a_block_can_be_taken_alone(photos: Path) -> None:
    made = indexed(photos, CATALOGUE, Question(blocks=["994"]))
    assert pairs(photos) == [("b/994_1.jpg", "1")]
    assert (made.without_front, made.rejections) == ((), ())


def test_indexing_twice_writes_the_same_bytes(photos: Path) -> None:
    city = photos.parent / "city"
    indexed(photos, CATALOGUE)
    first = {path.name: path.read_bytes() for path in city.iterdir()}
    indexed(photos, CATALOGUE)
    assert {path.name: path.read_bytes() for path in city.iterdir()} == first


@pytest.mark.parametrize("title", ["<b>x</b>\n\0", "x" * 10_000, "\udcff"])
def test_a_hostile_title_becomes_one_short_line(photos: Path, title: str) -> None:
    indexed(photos, CATALOGUE, Question(title=title))
    kept = manifest.read(Store(str(photos.parent / "city"))).title
    assert len(kept) <= 100
    assert kept == "" or kept.isprintable()


def test_without_a_catalogue_file_names_tell_the_lots(photos: Path) -> None:
    made = indexed(photos, None)
    assert (made.photos, made.blocks) == (3, 2)
    assert ("b/993_2.jpg", "2") in pairs(photos)


def test_a_folder_of_holiday_names_becomes_one_row(tmp_path: Path) -> None:
    folder = tmp_path / "main-street"
    folder.mkdir()
    for name in ("bakery.jpg", "corner.jpg", "school.jpg"):
        (folder / name).write_bytes(b"x")
    made = indexed(folder, None)
    assert (made.photos, made.fronts, made.blocks) == (3, 3, 1)


def test_a_stranger_is_kept_without_a_front_and_named(photos: Path) -> None:
    (photos / "stranger.jpg").write_bytes(b"x")
    made = indexed(photos, CATALOGUE)
    assert made.without_front == ("stranger.jpg",)
    assert ("stranger.jpg", None) in pairs(photos)
    assert [one.key for one in made.rejections] == ["stranger.jpg"]


@pytest.mark.parametrize(
    ("name", "lot"),
    [
        ("nynyma_rec0040_1_00993_0008a.jpg", ("993", "8")),
        ("b/993_8a.jpg", ("993", "8")),
        ("993-08.png", ("993", "8")),
        ("block 993 lot 8.tif", ("993", "8")),
        ("bakery.jpg", None),
        ("IMG_20231104_1200.jpg", None),
    ],
)
def test_file_names_tell_block_and_lot(name: str, lot: tuple[str, str] | None) -> None:
    assert profile(USUAL).naming.guessed(name) == lot


def test_an_empty_folder_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(Nothing, match=tmp_path.name):
        index(tmp_path, None, str(tmp_path / "city"))


def test_a_missing_folder_is_refused_by_name(tmp_path: Path) -> None:
    with pytest.raises(Nothing, match="nowhere is no folder"):
        index(tmp_path / "nowhere", None, str(tmp_path / "city"))


@pytest.mark.parametrize(
    "text", ["", "a,b\n1,2\n", "block,lot\n,\n", "\0\0", 'a"b,"\n']
)
def test_a_nonsense_catalogue_is_refused_by_name(photos: Path, text: str) -> None:
    with pytest.raises(Nothing, match=r"list\.csv"):
        indexed(photos, text)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("photo|block|lot\nb/993_1.jpg|993|1\n", "save it with commas"),
        ("block,lot\n993,\n", "row 2: no lot: fill in the cell"),
        ("block,lot\n993,1,7\n", "row 2: too many cells"),
    ],
)
def test_a_catalogue_without_a_good_row_names_its_first_bad_one(
    photos: Path, text: str, words: str
) -> None:
    with pytest.raises(Nothing, match=words):
        indexed(photos, text)


def test_a_file_whose_name_is_no_text_is_named_and_spoils_no_other(
    tmp_path: Path,
) -> None:
    folder = tmp_path / "photos"
    folder.mkdir()
    for name in (b"\xff.jpg", b"5_1.jpg", b"two\nlines.jpg"):
        Path(os.fsdecode(os.fsencode(folder) + b"/" + name)).write_bytes(b"x")
    made = indexed(folder, None)
    assert made.photos == 2
    assert [one.key for one in made.rejections] == ["\\xff.jpg"]
    (folder / "5_1.jpg").unlink()
    (folder / "two\nlines.jpg").unlink()
    with pytest.raises(Nothing, match="rename the file"):
        indexed(folder, None)


@pytest.mark.parametrize("name", ["x" * 100, "a\\b"])
def test_a_folder_whose_name_is_no_block_s_is_a_row_all_the_same(
    tmp_path: Path, name: str
) -> None:
    folder = tmp_path / "photos" / name
    folder.mkdir(parents=True)
    (folder / "bakery.jpg").write_bytes(b"x")
    made = indexed(tmp_path / "photos", None)
    assert (made.photos, made.fronts, made.rejections) == (1, 1, ())


NAMES = (
    " a.jpg",
    "a .jpg",
    "b.jpg ",
    "\tc.jpg",
    "d\n.jpg",
    "\u00a0e.jpg",
    "c:x.jpg",
    "..\\x.jpg",
    "=cmd|calc.jpg",
    "'=y.jpg",
    " /bakery.jpg",
    "folder\n/ f.jpg",
)


def write(folder: Path, *names: str) -> Path:
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(b"x")
    return folder


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("listed", [True, False])
@pytest.mark.parametrize("mended", [True, False])
def test_a_name_that_is_legal_on_disk_is_found_by_name(
    tmp_path: Path,
    name: str,
    listed: bool,  # noqa: FBT001
    mended: bool,  # noqa: FBT001
) -> None:
    folder = write(tmp_path / "photos ", name)
    table = io.StringIO(newline="")
    csv.writer(table).writerows([("photo", "block", "lot"), (name, 1, 1)])
    made = indexed(folder, table.getvalue() if listed else None)
    assert (made.photos, made.without_front, made.rejections) == (1, (), ())
    city = tmp_path / "city"
    if mended:
        (city / manifest.PARQUET).unlink()
    found = manifest.read(Store(str(city)))
    (row,) = located(found, str(city), ()).rows
    assert Path(row.root, row.photo) == folder / name


def test_blanks_that_no_name_has_are_no_part_of_it(tmp_path: Path) -> None:
    folder = write(tmp_path / "photos", "5_1.jpg")
    city = tmp_path / "city"
    indexed(folder, None)
    text = (city / manifest.CSV).read_text()
    (city / manifest.CSV).write_text(
        text.replace("photos,5_1.jpg", "photos , 5_1.jpg ")
    )
    (row,) = located(manifest.read(Store(str(city))), str(city), ()).rows
    assert Path(row.root, row.photo) == folder / "5_1.jpg"


@pytest.mark.parametrize("kind", ["pipe", "device", "holes"])
def test_a_catalogue_that_has_no_end_is_refused_by_name(
    photos: Path, kind: str
) -> None:
    hostile(photos.parent / "list.csv", kind)
    with pytest.raises(Nothing, match=r"list\.csv: (Not a regular|Larger than)"):
        index(photos, photos.parent / "list.csv", str(photos.parent / "city"))


def test_what_is_no_file_is_named_and_spoils_no_other(photos: Path) -> None:
    hostile(photos / "pipe.jpg", "pipe")
    (photos / "gone.jpg").symlink_to("nowhere")
    (photos / "link").symlink_to(photos / "b")
    made = indexed(photos, CATALOGUE)
    assert made.photos == 3
    assert [(one.key, one.reason) for one in made.rejections] == [
        ("gone.jpg", "no regular file"),
        ("link", "link to a folder"),
        ("pipe.jpg", "no regular file"),
    ]


def test_pictures_of_other_formats_are_told_and_others_are_not(photos: Path) -> None:
    for name in ("b/IMG_1.HEIC", "scan.pdf", "c.jfif", "notes.md", ".pdf", "list.csv"):
        (photos / name).write_bytes(b"x")
    made = indexed(photos, None)
    assert made.photos == 4  # and one that a browser calls JFIF
    unread = [one for one in made.rejections if one.reason.startswith("a format")]
    assert [one.key for one in unread] == ["b/IMG_1.HEIC", "scan.pdf"]
    assert all("save it as JPEG" in one.detail for one in unread)


def test_a_folder_that_can_not_be_read_is_named(photos: Path) -> None:
    deep = photos
    while len(str(deep)) < 3890:  # with another name the system refuses it
        deep = deep / ("x" * 200)
        deep.mkdir()
    before = os.open(deep, os.O_RDONLY)
    os.mkdir("y" * 200, dir_fd=before)
    os.close(before)
    (one,) = indexed(photos, CATALOGUE).rejections
    assert one.reason == "unreadable folder"
    assert one.key.endswith("y" * 200)


def test_folders_may_be_deeper_than_python_calls(photos: Path) -> None:
    folders = [f"{photos}{'/x' * depth}" for depth in range(1, 1501)]
    for folder in folders:
        Path(folder).mkdir()
    image = Path(folders[-1], "9_1.jpg")
    image.write_bytes(b"x")
    try:
        assert indexed(photos, None).photos == 4
    finally:  # who cleans up calls as deep
        image.unlink()
        for folder in reversed(folders):
            Path(folder).rmdir()


def test_a_cell_that_is_too_long_costs_its_row_alone(photos: Path) -> None:
    made = indexed(photos, CATALOGUE.replace("torn", "x" * 10_000_000))
    (row, photo) = made.rejections
    assert (row.key, row.reason) == ("list.csv row 3", "cell too long")
    assert "'remark' has 10,000,000 letters" in row.detail
    assert (photo.key, made.fronts) == ("b/993_2.jpg", 3)


def test_a_block_of_more_lots_than_any_has_is_named_and_spoils_no_other(
    photos: Path,
) -> None:
    rows = "".join(f",7,{lot},Elm Street,{lot},8,\n" for lot in range(1, 20_001))
    made = indexed(photos, CATALOGUE + rows)
    (one,) = made.rejections
    assert (one.key, one.reason) == ("block 7", "20,000 lots")
    assert (made.photos, made.fronts, made.blocks) == (3, 4, 2)
    with pytest.raises(Nothing, match="block 7: 20,000 lots"):
        indexed(photos, CATALOGUE.splitlines()[0] + "\n" + rows)


def test_what_is_indexed_of_the_largest_block_can_be_built(photos: Path) -> None:
    rows = "".join(f",7,{lot},Elm Street,{2 * lot},8,\n" for lot in range(1, 10_000))
    made = indexed(photos, CATALOGUE.splitlines()[0] + "\n" + rows)
    found = manifest.read(Store(str(photos.parent / "city")))
    assert (made.fronts, found.rejections) == (9_999, ())


def test_a_list_of_streets_and_houses_needs_no_blocks_and_lots(photos: Path) -> None:
    text = (
        "photo;street;house_no;width_m\r\nb/993_1.jpg;Elm St.;12 1/2;7,5\r\n"
        "b/994_1.jpg;Elm Street;14-16;\r\nb/993_2.jpg;ELM STREET;13;8\r\n"
    )
    made = indexed(photos, text)
    assert (made.photos, made.fronts, made.blocks) == (3, 3, 1)
    assert not made.without_front
    assert any("each street is taken for a block" in told for told in made.warnings)
    read = manifest.read(Store(str(photos.parent / "city"))).rows
    fronts = {row.photo: row.front for row in read if row.front is not None}
    assert {front.street for front in fronts.values()} == {"Elm Street"}
    assert fronts["b/993_1.jpg"].width_m == pytest.approx(7.5)
    assert fronts["b/993_1.jpg"].ring == fronts["b/994_1.jpg"].ring  # even, and across
    assert fronts["b/993_1.jpg"].ring != fronts["b/993_2.jpg"].ring  # the street, odd


def test_a_photograph_that_is_not_there_is_named_in_one_line(photos: Path) -> None:
    text = CATALOGUE.replace(",993,3,", "b/995_9.jpg,993,3,") + "gone.jpg,993,4,,,,\n"
    told = [one for one in indexed(photos, text).warnings if "not among those" in one]
    assert len(told) == 1
    assert "2 photographs" in told[0]
    assert "row 4 'b/995_9.jpg', row 6 'gone.jpg'" in told[0]
    quiet = indexed(photos, CATALOGUE).warnings
    assert not any("not among those" in one for one in quiet)


def test_a_missing_catalogue_is_refused_by_name(photos: Path) -> None:
    with pytest.raises(Nothing, match=r"gone\.csv"):
        index(photos, photos / "gone.csv", str(photos.parent / "city"))


def test_a_block_that_is_not_there_is_named(photos: Path) -> None:
    with pytest.raises(Nothing, match="1000"):
        indexed(photos, CATALOGUE, Question(blocks=["1000"]))


def test_an_empty_line_is_counted_and_else_ignored(photos: Path) -> None:
    text = CATALOGUE.replace("b/993_2", "\n,,,,,,\nb/993_2").replace(",3,8,", ",3,x,")
    made = indexed(photos, text)
    assert [one.key for one in made.rejections] == ["list.csv row 5", "b/993_2.jpg"]


def test_a_carriage_return_in_a_name_does_not_break_the_mended_manifest(
    tmp_path: Path,
) -> None:
    folder = tmp_path / "photos"
    folder.mkdir()
    for name in ("5_1.jpg", "two\rlines.jpg"):
        (folder / name).write_bytes(b"x")
    indexed(folder, None)
    path = tmp_path / "city" / manifest.CSV
    path.write_bytes(path.read_bytes().replace(b"7.62", b"8"))
    assert sorted(lot for lot, _ in pairs(folder)) == ["5_1.jpg", "two\rlines.jpg"]


def test_a_bad_row_is_named_and_spoils_no_other(photos: Path) -> None:
    made = indexed(
        photos, CATALOGUE.replace("First Street,1,10", "First Street,1,wide")
    )
    assert made.rejections[0].key == "list.csv row 2"
    assert made.fronts == 3


@needs_data
def test_block_993_of_the_archive_has_its_twenty_photos_on_two_rings(
    tmp_path: Path,
) -> None:
    folder = DATA / "taxphotos"
    city = str(tmp_path / "city")
    alone = Question(blocks=["993"])
    made = index(folder / "photos", folder / "catalogue.csv", city, alone)
    assert made.photos == 20
    rows = manifest.read(Store(city)).rows
    assert {row.front.ring for row in rows if row.front} == {0, 1}
