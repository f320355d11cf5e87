"""Files that claim to be photographs: cut short, overgrown, disguised, or merely odd."""

import io
import struct
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Final

import numpy as np
from PIL import Image, TiffImagePlugin

SHAPE: Final = (96, 128)  # h, w
PIXELS: Final = "damaged pixels"
HEADER: Final = "damaged header"
STRANGER: Final = "not a picture"
LARGE: Final = "too large"
SMALL: Final = "too small"
ORIENTATION: Final = 0x0112

Make = Callable[[], bytes]


@dataclass(frozen=True)
class HostileImage:
    """A file's bytes, and the reason it is rejected for; none for a photograph."""

    name: str  # of the file
    make: Make
    reason: str = ""


def street(shape: tuple[int, int] = SHAPE) -> np.ndarray:
    """Paint something smooth, different in each corner."""
    y, x = np.mgrid[: shape[0], : shape[1]]
    return (40 + 100 * x / shape[1] + 90 * y / shape[0]).astype(np.uint8)


def noise(shape: tuple[int, int] = SHAPE) -> np.ndarray:
    return np.random.default_rng(7).integers(0, 256, shape, np.uint8)


def encoded(pixels: np.ndarray, kind: str, mode: str = "L", **options: Any) -> bytes:
    sink = io.BytesIO()
    Image.fromarray(pixels).convert(mode).save(sink, kind, **options)
    return sink.getvalue()


def cut(kind: str, mode: str, share: float) -> bytes:
    """Leave a share of an encoded picture of noise, which no format makes small."""
    whole = encoded(noise(), kind, mode)
    return whole[: round(share * len(whole))]


# What is left of each format, and why it is refused: its header fits in the first
# hundredth part of none.
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


def png(width: int, height: int, *, body: bytes = b"\0" * 64, depth: int = 8) -> bytes:
    """Write a sound PNG header that promises a size, and `body` for its pixels."""
    size = struct.pack(">IIBBBBB", width, height, depth, 0, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", size)
        + chunk(b"IDAT", zlib.compress(body, 9))
        + chunk(b"IEND", b"")
    )


def chunk(kind: bytes, body: bytes) -> bytes:
    """Write one piece of a PNG with its length and checksum."""
    check = struct.pack(">I", zlib.crc32(kind + body))
    return struct.pack(">I", len(body)) + kind + body + check


def text_bomb() -> bytes:
    """Hide 16 MB of blanks in a comment of a small PNG."""
    whole = encoded(street(), "PNG")
    comment = b"a\0\0" + zlib.compress(b" " * 16_000_000, 9)
    return whole[:33] + chunk(b"zTXt", comment) + whole[33:]


def jpeg(width: int, height: int) -> bytes:
    """Change the size that a JPEG's header tells."""
    whole = encoded(street(), "JPEG")
    at = whole.index(b"\xff\xc0") + 5
    return whole[:at] + struct.pack(">HH", height, width) + whole[at + 4 :]


def gif(width: int, height: int) -> bytes:
    whole = encoded(street(), "GIF")
    return whole[:6] + struct.pack("<HH", width, height) + whole[10:]


def bmp(width: int, height: int) -> bytes:
    whole = encoded(street(), "BMP")
    return whole[:18] + struct.pack("<ii", width, height) + whole[26:]


def tiff(pixels: np.ndarray, tags: dict[int, Any] | None = None) -> bytes:
    """Write a TIFF with some of its tags changed."""
    told = TiffImagePlugin.ImageFileDirectory_v2()
    for tag, value in (tags or {}).items():
        told[tag] = value
    sink = io.BytesIO()
    Image.fromarray(pixels).save(sink, "TIFF", tiffinfo=told)
    return sink.getvalue()


def tiff_of(entries: dict[int, tuple[int, int, int]]) -> bytes:
    """Write a TIFF's directory by hand: for each tag its type, count and value."""
    listed = [
        struct.pack("<HHII", tag, *entry) for tag, entry in sorted(entries.items())
    ]
    count = struct.pack("<H", len(listed))
    return b"II*\0\x08\0\0\0" + count + b"".join(listed) + b"\0" * 4


def huge_tiff() -> bytes:
    long = 4
    told = {256: 60_000, 257: 60_000, 258: 8, 259: 1, 262: 1, 273: 8, 278: 60_000}
    return tiff_of({tag: (long, 1, value) for tag, value in told.items()})


def endless_tiff() -> bytes:
    """Let a TIFF's only directory name itself as the next one."""
    whole = tiff(street())
    at = struct.unpack("<I", whole[4:8])[0]
    (entries,) = struct.unpack("<H", whole[at : at + 2])
    end = at + 2 + 12 * entries
    return whole[:end] + struct.pack("<I", at) + whole[end + 4 :]


def paged(kind: str, pages: int) -> bytes:
    pictures = [Image.fromarray(np.roll(noise(), n)) for n in range(pages)]
    sink = io.BytesIO()
    pictures[0].save(sink, kind, save_all=True, append_images=pictures[1:])
    return sink.getvalue()


def turned(orientation: int) -> bytes:
    exif = Image.Exif()
    exif[ORIENTATION] = orientation
    return encoded(street(), "JPEG", exif=exif.tobytes())


def with_exif(data: bytes) -> bytes:
    """Put anything where a JPEG's EXIF stands."""
    whole = encoded(street(), "JPEG")
    body = b"Exif\0\0" + data
    head = struct.pack(">BBH", 0xFF, 0xE1, len(body) + 2)
    return whole[:2] + head + body + whole[2:]


def with_profile(kind: str, profile: bytes) -> bytes:
    return encoded(street(), kind, "RGB", icc_profile=profile)


def page() -> bytes:
    return b"<!DOCTYPE html><html><script>alert(1)</script><body>404</body></html>" * 9


def archive() -> bytes:
    sink = io.BytesIO()
    with zipfile.ZipFile(sink, "w") as file:
        file.writestr("photo.jpg", encoded(street(), "JPEG"))
    return sink.getvalue()


def floats(kind: str) -> bytes:
    pixels = street().astype(np.float32)
    if kind == "nan":
        pixels[:] = np.nan
    elif kind == "some_nan":
        pixels[::7] = np.nan
    elif kind == "infinite":
        pixels[::5], pixels[1::5] = np.inf, -np.inf
    elif kind == "huge":
        pixels *= np.float32(1e36)
    return tiff(pixels)


def deep(top: int, kind: str) -> bytes:
    return encoded_deep((street().astype(np.uint32) * top // 255), kind)


def encoded_deep(pixels: np.ndarray, kind: str) -> bytes:
    sink = io.BytesIO()
    Image.fromarray(pixels.astype(np.uint16)).save(sink, kind)
    return sink.getvalue()


def cmyk() -> bytes:
    return encoded(street(), "JPEG", "CMYK")


def transparent(mode: str) -> bytes:
    whole = np.dstack([street()] * 3 + [np.zeros(SHAPE, np.uint8)])
    sink = io.BytesIO()
    Image.fromarray(whole).convert(mode).save(sink, "PNG")
    return sink.getvalue()


def spoiled(kind: str, mode: str = "L") -> bytes:
    """Overwrite 64 bytes in the middle with zeros."""
    whole = bytearray(encoded(noise(), kind, mode))
    middle = len(whole) // 2
    whole[middle : middle + 64] = bytes(64)
    return bytes(whole)


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


def rubbished(magic: bytes) -> bytes:
    return magic + np.random.default_rng(3).bytes(2000)


def marked_start(kind: str) -> bytes:
    """Put a mark of UTF-8 before a picture, as an editor of text does."""
    return b"\xef\xbb\xbf" + encoded(street(), kind)


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


def zeros(side: int) -> bytes:
    """Write black pixels, a thousand of them a byte, below the limit."""
    return png(side, side, body=bytes(side * (side + 1)))


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


def encoded_lab(pixels: np.ndarray) -> bytes:
    planes = [Image.fromarray(pixels)] * 3
    sink = io.BytesIO()
    Image.merge("LAB", planes).save(sink, "TIFF")
    return sink.getvalue()


def wrong_checksum() -> bytes:
    whole = bytearray(encoded(street(), "PNG"))
    whole[30] ^= 0xFF
    return bytes(whole)


def many_tags() -> bytes:
    """Let a TIFF's directory claim values that lie where no file reaches."""
    far = dict.fromkeys(range(256, 300), (5, 2**30, 2**31))
    return tiff_of(far)


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


def text_orientation() -> bytes:
    """Write the orientation as text, where a number belongs."""
    entry = struct.pack("<HHI4s", ORIENTATION, 2, 4, b"up!\0")
    return b"II*\0\x08\0\0\0\x01\0" + entry + b"\0" * 4


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
