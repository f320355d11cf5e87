from dataclasses import replace

import pytest

from nostalgin_core.records import Front
from pipelines.build.options import options, part
from pipelines.index.plan import falls_to, plan
from pipelines.index.roots import rooted
from pipelines.index.row import Row

FRONT = Front("1-1-0", "1", "1", 0, 0, 0, "Elm Street", "1", 8.0, None, False)  # noqa: FBT003


def row(number: int, photo: str, block: str | None, *, rank: int = 0) -> Row:
    front = None
    if block is not None:
        front = replace(FRONT, front_id=f"{block}-{rank}-0", block=block, rank=rank)
    return Row(number, "/photos", photo, front, "", {})


ROWS = [
    row(2, "a.jpg", "1"),
    row(3, "a.jpg", "2"),
    row(4, "b.jpg", "2", rank=1),
    row(5, "", "3"),
    row(6, "stray.jpg", None),
]


def test_each_photo_is_worked_on_once_for_all_its_blocks() -> None:
    made = plan(ROWS, city="/city")
    assert [(ref.name, ref.blocks) for ref in made.photos] == [
        ("a.jpg", ("1", "2")),
        ("b.jpg", ("2",)),
    ]


def test_each_block_knows_its_fronts_and_who_may_show_them() -> None:
    made = plan(ROWS, city="/city")
    assert [one.block for one in made.blocks] == ["1", "2", "3"]
    a, b = ("/photos", "a.jpg"), ("/photos", "b.jpg")
    assert made.blocks[1].photos == ((a, "2-0-0"), (b, "2-1-0"))
    assert made.blocks[2].photos == ()


def test_photos_of_one_name_in_two_folders_are_two_photos() -> None:
    other = replace(row(3, "a.jpg", "1", rank=1), root="more")
    made = plan([row(2, "a.jpg", "1"), other], city="/city")
    assert [ref.root for ref in made.photos] == ["/city/more", "/photos"]
    assert made.blocks[0].photos == (
        (("/city/more", "a.jpg"), "1-1-0"),
        (("/photos", "a.jpg"), "1-0-0"),
    )


def test_a_photo_without_a_front_is_rejected_with_its_row() -> None:
    (one,) = plan(ROWS, city="/city").rejections
    assert (one.key, one.reason) == ("stray.jpg", "no front known")
    assert "manifest.csv row 6" in one.detail


def test_the_order_of_rows_changes_nothing() -> None:
    assert plan(ROWS[::-1], city="/city") == plan(ROWS, city="/city")


def test_shards_are_a_partition_of_the_blocks() -> None:
    blocks = [str(number) for number in range(200)]
    owners = [sum(falls_to(block, (k, 7)) for k in range(1, 8)) for block in blocks]
    assert set(owners) == {1}
    sizes = [sum(falls_to(block, (k, 7)) for block in blocks) for k in range(1, 8)]
    assert min(sizes) > 10


def test_a_shard_has_the_photos_of_its_blocks_alone() -> None:
    parts = [plan(ROWS, city="/city", shard=(k, 4)) for k in range(1, 5)]
    assert sorted(one.block for part in parts for one in part.blocks) == ["1", "2", "3"]
    for each in parts:
        own = {one.block for one in each.blocks}
        assert all(set(ref.blocks) <= own for ref in each.photos)


def test_a_relative_photo_folder_counts_from_the_city() -> None:
    assert rooted("../photos", "/home/city") == "/home/photos"
    assert rooted("/photos", "/home/city") == "/photos"
    assert rooted("s3://bucket/photos", "/home/city") == "s3://bucket/photos"
    assert rooted("../photos", "s3://bucket/city/") == "s3://bucket/photos"


@pytest.mark.parametrize("shard", ["0/3", "4/3", "3", "a/b", "1/0", "-1/2"])
def test_a_nonsense_shard_is_refused_with_an_example(shard: str) -> None:
    with pytest.raises(ValueError, match="3/16"):
        part(shard)


@pytest.mark.parametrize("runner", [[], ["--runner=DirectRunner"]])
def test_the_embedded_runner_stands_for_the_direct_one(runner: list[str]) -> None:
    made = options("city", beam=runner)
    assert made.get_all_options()["runner"] == "FnApiRunner"


def test_another_runner_is_left_alone() -> None:
    made = options("city", beam=["--runner=FlinkRunner"])
    assert made.get_all_options()["runner"] == "FlinkRunner"


@pytest.mark.parametrize(
    ("beam", "words"),
    [
        (["--max-rejcted", "0.1"], "--max-rejcted: neither"),
        (["other-city"], "other-city: neither"),
        (["--shar=1/2"], "--shar=1/2: neither"),
        (["--shard", "1/2"], "this command sets it"),
        (["--city=elsewhere"], "this command sets it"),
        (["--runner=NoSuchRunner"], "NoSuchRunner"),
        (["--runner=no.such.Runner"], "no.such.Runner"),
        (["--direct_num_workers=-1"], "0 for one on each core"),
    ],
)
def test_options_that_nobody_knows_are_refused(beam: list[str], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        options("city", beam=beam)


def test_a_cluster_s_runner_may_know_more_options() -> None:
    options("city", beam=["--runner=FlinkRunner", "--checkpointing_interval=9"])
