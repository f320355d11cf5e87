"""What people have written is never lost: a manifest that was mended by hand."""

from pathlib import Path

import pytest

from pipelines.index import manifest
from pipelines.index.images import Nothing, images
from pipelines.index.index import Indexed, index
from pipelines.store.store import Store


@pytest.fixture
def photos(tmp_path: Path) -> Path:
    folder = tmp_path / "photos"
    folder.mkdir()
    for name in ("993_1.jpg", "993_2.jpg"):
        (folder / name).write_bytes(b"x")
    return folder


def indexed(photos: Path, **options: bool) -> Indexed:
    return index(photos, None, str(photos.parent / "city"), **options)


def mend(photos: Path) -> bytes:
    csv = photos.parent / "city" / manifest.CSV
    csv.write_text(csv.read_text().replace("993-2", "993-two"))
    return csv.read_bytes()


def copies(photos: Path) -> list[bytes]:
    found = sorted((photos.parent / "city").glob("manifest.2*.csv"))
    return [one.read_bytes() for one in found]


def test_a_manifest_as_index_wrote_it_is_written_anew(photos: Path) -> None:
    assert indexed(photos) == indexed(photos)
    assert copies(photos) == []


def test_a_mended_manifest_is_kept(photos: Path) -> None:
    indexed(photos)
    mended = mend(photos)
    with pytest.raises(Nothing, match="--force"):
        indexed(photos)
    assert (photos.parent / "city" / manifest.CSV).read_bytes() == mended


def test_it_is_kept_after_a_build_has_read_it_too(photos: Path) -> None:
    indexed(photos)
    mend(photos)
    store = Store(str(photos.parent / "city"))
    manifest.rewrite(store, manifest.read(store))
    assert not manifest.read(store).mended
    with pytest.raises(Nothing, match="--force"):
        indexed(photos)


def test_a_list_that_somebody_wrote_alone_is_kept(photos: Path) -> None:
    indexed(photos)
    (photos.parent / "city" / manifest.PARQUET).unlink()
    with pytest.raises(Nothing, match="--force"):
        indexed(photos)


def test_it_is_kept_where_only_its_other_form_is_left(photos: Path) -> None:
    indexed(photos)
    mend(photos)
    store = Store(str(photos.parent / "city"))
    manifest.rewrite(store, manifest.read(store))
    (photos.parent / "city" / manifest.CSV).unlink()
    whole = (photos.parent / "city" / manifest.PARQUET).read_bytes()
    with pytest.raises(Nothing, match=r"manifest\.parquet"):
        indexed(photos)
    indexed(photos, force=True)
    (copy,) = (photos.parent / "city").glob("manifest.2*.parquet")
    assert copy.read_bytes() == whole


def test_by_force_it_is_replaced_and_a_copy_is_kept_each_time(photos: Path) -> None:
    indexed(photos)
    first = mend(photos)
    told = indexed(photos, force=True)
    second = mend(photos)
    indexed(photos, force=True)
    assert copies(photos) == [first, second]
    assert any("keeps the manifest" in warning for warning in told.warnings)
    indexed(photos)


@pytest.mark.parametrize("folder", ["site/photos", "site", "artifacts", "runs/1"])
def test_photos_where_build_writes_are_refused(folder: str, tmp_path: Path) -> None:
    (tmp_path / folder).mkdir(parents=True)
    (tmp_path / folder / "993_1.jpg").write_bytes(b"x")
    with pytest.raises(Nothing, match="where build writes"):
        images(tmp_path / folder, str(tmp_path))


@pytest.mark.parametrize("city", ["..", ".", "city"])
def test_what_build_wrote_is_no_photo(city: str, photos: Path) -> None:
    own = photos / city
    for name in ("site/photos/a.webp", "artifacts/b.png"):
        (own / name).parent.mkdir(parents=True, exist_ok=True)
        (own / name).write_bytes(b"x")
    assert images(photos, str(own))[0] == ["993_1.jpg", "993_2.jpg"]


@pytest.mark.parametrize("writes", range(4))
def test_who_is_killed_while_writing_a_manifest_leaves_the_old_or_the_new(
    photos: Path, writes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = indexed(photos)
    city = photos.parent / "city"
    old = manifest.read(Store(str(city))).rows
    (photos / "993_3.jpg").write_bytes(b"x")
    left = [writes]
    write = Store.write_bytes

    def killed(store: Store, name: str, data: bytes) -> None:
        if not left[0]:
            raise KeyboardInterrupt
        left[0] -= 1
        write(store, name, data)

    with monkeypatch.context() as there:
        there.setattr(Store, "write_bytes", killed)
        with pytest.raises(KeyboardInterrupt):
            indexed(photos)
    found = manifest.read(Store(str(city)))
    assert not found.mended
    assert len(found.rows) == len(old) + (writes > 1)
    assert indexed(photos).photos == first.photos + 1  # and nothing is lost by it
    assert not (city / "manifest.parquet.coming").exists()
