"""Files that claim to be photographs: cut short, overgrown, disguised, or odd."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final

import numpy as np

from tests.hostile.pictures import (
    SHAPE,
    archive,
    bmp,
    cmyk,
    cut,
    deep,
    encoded,
    encoded_lab,
    endless_tiff,
    floats,
    gif,
    huge_tiff,
    jpeg,
    many_tags,
    marked_start,
    noise,
    page,
    paged,
    png,
    rubbished,
    spoiled,
    street,
    text_bomb,
    text_orientation,
    tiff_of,
    transparent,
    turned,
    with_exif,
    with_profile,
    wrong_checksum,
    zeros,
)

PIXELS: Final = "damaged pixels"
HEADER: Final = "damaged header"
STRANGER: Final = "not a picture"
LARGE: Final = "too large"
SMALL: Final = "too small"
Make = Callable[[], bytes]


@dataclass(frozen=True)
class HostileImage:
    """A file's bytes, and the reason it is rejected for; none for a photograph."""

    name: str  # of the file
    make: Make
    reason: str = ""


CUTS: Final = {
    "JPEG": (0.01, 0.3, 0.9),
    "PNG": (0.001, 0.3, 0.9),
    "TIFF": (0.0005, 0.3, 0.9),
    "GIF": (0.0005, 0.3, 0.9),
    "BMP": (0.0005, 0.3, 0.9),
    "WEBP": (0.0005, 0.3, 0.9),
    "JPEG2000": (0.001, 0.3, 0.9),
}
SUFFIX: Final = {"JPEG": "jpg", "TIFF": "tif", "JPEG2000": "jp2"}


def cases() -> list[HostileImage]:
    """List all hostile images, each under a name of its own."""
    return [*truncated(), *disguised(), *overgrown(), *odd(), *marked(), *plain()]


def truncated() -> list[HostileImage]:
    made = []
    for kind, shares in CUTS.items():
        mode = "RGB" if kind in ("JPEG", "WEBP") else "L"
        suffix = SUFFIX.get(kind, kind.lower())
        for share in shares:
            whole_first = kind == "WEBP"  # its reader asks for all before it starts
            reason = HEADER if whole_first or share == shares[0] else PIXELS
            name = f"cut_{share:g}.{suffix}"
            made.append(HostileImage(name, partial(cut, kind, mode, share), reason))
    return made


def disguised() -> list[HostileImage]:
    one = HostileImage
    magics = {
        "jpg": b"\xff\xd8\xff",
        "png": b"\x89PNG\r\n\x1a\n",
        "tif": b"II*\0",
        "gif": b"GIF89a",
        "bmp": b"BM",
        "webp": b"RIFF\x40\0\0\0WEBPVP8 ",
        "jp2": b"\0\0\0\x0cjP  \r\n\x87\n",
    }
    bare = [
        one(f"magic_alone.{suffix}", partial(bytes, magic), HEADER)
        for suffix, magic in magics.items()
    ]
    rubbish = [
        one(f"magic_and_rubbish.{suffix}", partial(rubbished, magic), HEADER)
        for suffix, magic in magics.items()
    ]
    return [
        *bare,
        *rubbish,
        one("no_bytes.jpg", bytes, "empty file"),
        one("one_byte.jpg", partial(bytes, b"\xff"), STRANGER),
        one("two_bytes.jpg", partial(bytes, b"\xff\xd8"), STRANGER),
        one("zeros.jpg", partial(bytes, 4096), STRANGER),
        one("words.jpg", partial(bytes, b"no photograph at all\n" * 9), STRANGER),
        one("page.jpg", page, STRANGER),
        one("archive.jpg", archive, STRANGER),
        one(
            "program.jpg", partial(bytes, b"\x7fELF\x02\x01\x01" + bytes(99)), STRANGER
        ),
        one("drawing.png", partial(bytes, b"<svg xmlns='x'><image/></svg>"), STRANGER),
        one("postscript.jpg", partial(bytes, b"%!PS-Adobe-3.0 EPSF-3.0\n"), STRANGER),
        one("pdf.jpg", partial(bytes, b"%PDF-1.4\n%rubbish"), STRANGER),
        one(
            "sound.webp", partial(bytes, b"RIFF\x24\0\0\0WAVEfmt " + bytes(32)), HEADER
        ),
        one("magick.jpg", partial(bytes, b"push graphic-context\nimage x"), STRANGER),
        one("marked_jpeg.jpg", partial(marked_start, "JPEG"), STRANGER),
        one("png_named_jpg.jpg", partial(encoded, street(), "PNG")),
        one("jpeg_named_png.png", partial(encoded, street(), "JPEG")),
    ]


def overgrown() -> list[HostileImage]:
    one = HostileImage
    return [
        one("promises_60000.png", partial(png, 60_000, 60_000), LARGE),
        one("promises_most.png", partial(png, 2**31 - 1, 2**31 - 1), LARGE),
        one("promises_line.png", partial(png, 2**31 - 1, 64), LARGE),
        one("promises_60000.jpg", partial(jpeg, 60_000, 60_000), LARGE),
        one("promises_65535.gif", partial(gif, 65_535, 65_535), LARGE),
        one("promises_60000.bmp", partial(bmp, 60_000, 60_000), LARGE),
        one("promises_60000.tif", huge_tiff, LARGE),
        one("promises_little.png", partial(png, 4096, 4096), PIXELS),
        one("zeros_of_5000.png", partial(zeros, 5000)),
        one("text_bomb.png", text_bomb, HEADER),
        one("no_width.png", partial(png, 0, 100), HEADER),
        one("no_height.jpg", partial(jpeg, 100, 0), HEADER),
        one("negative.bmp", partial(bmp, -100, 100), LARGE),
        one("one_pixel.png", partial(encoded, street((1, 1)), "PNG"), SMALL),
        one("one_pixel.jpg", partial(encoded, street((1, 1)), "JPEG"), SMALL),
        one("hair.png", partial(encoded, street((1, 100_000)), "PNG"), SMALL),
        one("post.tif", partial(encoded, street((100_000, 1)), "TIFF"), SMALL),
        one("nearly.png", partial(encoded, street((63, 640)), "PNG"), SMALL),
    ]


def odd() -> list[HostileImage]:
    one = HostileImage
    kinds = ("nan", "some_nan", "infinite", "huge")
    return [
        *(one(f"float_{kind}.tif", partial(floats, kind)) for kind in kinds),
        one("deep.png", partial(deep, 65_535, "PNG")),
        one("twelve_bits.tif", partial(deep, 4095, "TIFF")),
        one("print_shop.jpg", cmyk),
        one("palette.png", partial(encoded, street(), "PNG", "P")),
        one("one_bit.tif", partial(encoded, street(), "TIFF", "1")),
        one("one_bit.bmp", partial(encoded, street(), "BMP", "1")),
        one("lab.tif", partial(encoded_lab, street())),
        one("clear.png", partial(transparent, "RGBA")),
        one("clear_gray.png", partial(transparent, "LA")),
        one("moving.gif", partial(paged, "GIF", 5)),
        one("moving.webp", partial(paged, "WEBP", 5)),
        one("moving.png", partial(paged, "PNG", 5)),
        one("pages.tif", partial(paged, "TIFF", 5)),
        one("hundred_pages.tif", partial(paged, "TIFF", 100)),
        one("endless_pages.tif", endless_tiff),
        one("spoiled.png", partial(spoiled, "PNG"), PIXELS),
        one("spoiled.jpg", partial(spoiled, "JPEG")),
        one("spoiled.bmp", partial(spoiled, "BMP")),
        one("wrong_checksum.png", wrong_checksum, HEADER),
        one(
            "no_strips.tif",
            partial(tiff_of, {256: (4, 1, 99), 257: (4, 1, 99)}),
            HEADER,
        ),
        one("many_tags.tif", many_tags, HEADER),
    ]


def marked() -> list[HostileImage]:
    """List pictures that are sound, with rubbish told about them."""
    one = HostileImage
    turns = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 65_535]
    cyclic = b"II*\0\x08\0\0\0\x01\0\x69\x87\x04\0\x01\0\0\0\x08\0\0\0\0\0\0\0"
    return [
        *(one(f"turned_{n}.jpg", partial(turned, n)) for n in turns),
        one("exif_rubbish.jpg", partial(with_exif, noise((10, 60)).tobytes())),
        one("exif_cut.jpg", partial(with_exif, b"II*\0\x08\0\0\0\xff\xff")),
        one("exif_empty.jpg", partial(with_exif, b"")),
        one("exif_in_itself.jpg", partial(with_exif, cyclic)),
        one("exif_text.jpg", partial(with_exif, text_orientation())),
        one("profile_rubbish.jpg", partial(with_profile, "JPEG", bytes(range(200)))),
        one("profile_rubbish.png", partial(with_profile, "PNG", b"acsp" * 999)),
        one("profile_empty.tif", partial(with_profile, "TIFF", b"\0")),
    ]


def plain() -> list[HostileImage]:
    """List pictures in which there is nothing to see."""
    one = HostileImage
    return [
        one("black.png", partial(encoded, np.zeros(SHAPE, np.uint8), "PNG")),
        one("white.jpg", partial(encoded, np.full(SHAPE, 255, np.uint8), "JPEG")),
        one("noise.png", partial(encoded, noise(), "PNG")),
        one("least.png", partial(encoded, street((64, 64)), "PNG")),
        one("ribbon.png", partial(encoded, street((64, 9000)), "PNG")),
    ]
