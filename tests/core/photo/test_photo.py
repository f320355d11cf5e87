import io
import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from nostalgin_core.photo import photo
from nostalgin_core.records import Photo, Rejection
from tests.data import DATA, needs_data


def _street(h: int = 96, w: int = 128) -> np.ndarray:
    """Smooth enough for JPEG, and different in each corner."""
    y, x = np.mgrid[:h, :w]
    return (40 + 100 * x / w + 90 * y / h).astype(np.uint8)


def _bytes(picture: Image.Image, extension: str, **options: object) -> bytes:
    out = io.BytesIO()
    picture.save(out, extension, **options)
    return out.getvalue()


def _decoded(data: bytes) -> Photo:
    result = photo.decode(data, name="street.jpg")
    assert isinstance(result, Photo), result
    return result


def _png_header(width: int, height: int) -> bytes:
    """A valid PNG header that promises a size, and almost no pixels."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        check = struct.pack(">I", zlib.crc32(kind + body))
        return struct.pack(">I", len(body)) + kind + body + check

    size = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", size)
        + chunk(b"IDAT", zlib.compress(b"\0" * 64))
        + chunk(b"IEND", b"")
    )


def test_gray_levels_are_kept_as_they_are() -> None:
    np.testing.assert_array_equal(
        _decoded(_bytes(Image.fromarray(_street()), "PNG")).image, _street()
    )


def test_the_key_is_the_contents_and_not_the_name() -> None:
    data = _bytes(Image.fromarray(_street()), "PNG")
    one, two = photo.decode(data, name="a.png"), photo.decode(data, name="b.png")
    assert one.key == two.key == photo.key(data)
    assert len(one.key) == 16


@pytest.mark.parametrize(
    "extension", ["JPEG", "PNG", "TIFF", "WEBP", "BMP", "JPEG2000"]
)
@pytest.mark.parametrize("mode", ["L", "RGB"])
def test_every_format_shows_the_same_street(extension: str, mode: str) -> None:
    data = _bytes(Image.fromarray(_street()).convert(mode), extension)
    np.testing.assert_allclose(
        _decoded(data).image.astype(int), _street().astype(int), atol=4
    )


@pytest.mark.parametrize("extension", ["JPEG", "TIFF"])
def test_cmyk_shows_the_same_street(extension: str) -> None:
    data = _bytes(Image.fromarray(_street()).convert("CMYK"), extension)
    np.testing.assert_allclose(
        _decoded(data).image.astype(int), _street().astype(int), atol=4
    )


def test_a_palette_shows_the_same_street() -> None:
    data = _bytes(Image.fromarray(_street()).convert("RGB").quantize(256), "PNG")
    np.testing.assert_allclose(
        _decoded(data).image.astype(int), _street().astype(int), atol=8
    )


def test_what_is_transparent_is_paper() -> None:
    alpha = np.full((96, 128), 255, np.uint8)
    alpha[:, :40] = 0
    layers = np.dstack([_street(), alpha])
    image = _decoded(_bytes(Image.fromarray(layers, "LA"), "PNG")).image
    assert (image[:, :40] == 255).all()
    np.testing.assert_array_equal(image[:, 40:], _street()[:, 40:])


@pytest.mark.parametrize("extension", ["TIFF", "PNG"])
@pytest.mark.parametrize("bits", [8, 12, 16])
def test_deep_gray_is_scaled_by_the_depth_that_was_used(
    extension: str, bits: int
) -> None:
    full = 2**bits - 1
    deep = np.round(_street() / 255.0 * full).astype(np.uint16)
    deep[0, 0] = full
    image = _decoded(_bytes(Image.fromarray(deep), extension)).image
    assert image.dtype == np.uint8
    np.testing.assert_allclose(image[1:].astype(int), _street()[1:].astype(int), atol=1)


def test_a_deep_negative_is_told_by_its_tag() -> None:
    deep = _street().astype(np.uint16) * 257
    data = _bytes(Image.fromarray(65535 - deep), "TIFF", tiffinfo={262: 0})
    np.testing.assert_allclose(
        _decoded(data).image.astype(int), _street().astype(int), atol=1
    )


def test_floats_are_stretched_over_their_range() -> None:
    image = _decoded(_bytes(Image.fromarray(_street() / np.float32(7.0)), "TIFF")).image
    assert (image.min(), image.max()) == (0, 255)


@pytest.mark.parametrize("extension", ["JPEG", "TIFF", "PNG"])
@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_turns_the_photo_upright(extension: str, orientation: int) -> None:
    upright = _street()
    stored = {
        1: upright,
        2: upright[:, ::-1],
        3: upright[::-1, ::-1],
        4: upright[::-1],
        5: upright.T,
        6: np.rot90(upright),
        7: upright[::-1, ::-1].T,
        8: np.rot90(upright, -1),
    }[orientation]
    exif = Image.Exif()
    exif[0x0112] = orientation
    picture = Image.fromarray(np.ascontiguousarray(stored))
    image = _decoded(_bytes(picture, extension, exif=exif)).image
    np.testing.assert_allclose(image.astype(int), upright.astype(int), atol=4)


def test_the_first_of_several_pages_is_read() -> None:
    pages = [Image.fromarray(_street()), Image.fromarray(255 - _street())]
    data = _bytes(pages[0], "TIFF", save_all=True, append_images=pages[1:])
    np.testing.assert_array_equal(_decoded(data).image, _street())


def _cases() -> dict[str, tuple[bytes, str, str]]:
    jpeg = _bytes(Image.fromarray(_street(480, 640)), "JPEG")
    tiny = _bytes(Image.fromarray(_street(40, 640)), "PNG")
    return {
        "no bytes": (b"", "empty file", "copy it again"),
        "a text named .jpg": (b"Dear Sir, enclosed", "not a picture", "JPEG, PNG"),
        "a cut JPEG": (jpeg[: len(jpeg) // 2], "damaged pixels", "copy or scan"),
        "a JPEG cut in its header": (jpeg[:12], "damaged header", "copy or scan"),
        "a huge header": (_png_header(60_000, 60_000), "too large", "60000 x 60000"),
        "a strip": (tiny, "too small", "640 x 40"),
        "a PNG without pixels": (_png_header(99, 99), "damaged pixels", "copy or scan"),
    }


@pytest.mark.parametrize("case", _cases())
def test_a_file_that_cannot_be_read_is_refused_with_the_remedy(case: str) -> None:
    data, reason, words = _cases()[case]
    result = photo.decode(data, name="box 7/street.jpg")
    assert isinstance(result, Rejection)
    assert (result.stage, result.reason) == ("photo", reason)
    assert result.detail.startswith("box 7/street.jpg: ")
    assert words in result.detail


def test_the_limit_is_the_callers() -> None:
    data = _bytes(Image.fromarray(_street()), "PNG")
    assert not photo.decode(data, name="a.png", max_megapixels=0.01)


@pytest.mark.parametrize(
    ("extension", "mode"),
    [
        ("JPEG", "RGB"),
        ("PNG", "RGBA"),
        ("TIFF", "L"),
        ("WEBP", "RGB"),
        ("GIF", "P"),
        ("BMP", "L"),
        ("JPEG2000", "L"),
    ],
)
def test_damaged_bytes_are_refused_or_read_but_never_raise(
    extension: str, mode: str
) -> None:
    rng = np.random.default_rng(7)
    whole = _bytes(Image.fromarray(_street()).convert(mode), extension)
    for trial in range(60):
        data = bytearray(whole)
        reach = len(data) if trial % 2 else min(200, len(data))
        for place in rng.integers(4, reach, rng.integers(1, 6)):
            data[place] = rng.integers(256)
        cut = rng.integers(8, len(data)) if trial % 3 == 0 else len(data)
        result = photo.decode(bytes(data[:cut]), name="x", max_megapixels=1.0)
        assert isinstance(result, Photo | Rejection)


@needs_data
def test_tax_photographs_are_read_with_their_border_found() -> None:
    path = DATA / "taxphotos" / "photos" / "nynyma_rec0040_1_00996_0001.jpg"
    read = photo.decode(path.read_bytes(), name=path.name)
    assert read.image.shape == (840, 560)
    assert read.frame.x0 > 0
    assert read.frame.y1 < 840
