"""Pictures, sound and damaged, made byte by byte where no encoder would make them."""

import io
import struct
import zipfile
import zlib
from typing import Any, Final

import numpy as np
from PIL import Image, TiffImagePlugin

SHAPE: Final = (96, 128)  # h, w
ORIENTATION: Final = 0x0112


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


def rubbished(magic: bytes) -> bytes:
    return magic + np.random.default_rng(3).bytes(2000)


def marked_start(kind: str) -> bytes:
    """Put a mark of UTF-8 before a picture, as an editor of text does."""
    return b"\xef\xbb\xbf" + encoded(street(), kind)


def zeros(side: int) -> bytes:
    """Write black pixels, a thousand of them a byte, below the limit."""
    return png(side, side, body=bytes(side * (side + 1)))


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


def text_orientation() -> bytes:
    """Write the orientation as text, where a number belongs."""
    entry = struct.pack("<HHI4s", ORIENTATION, 2, 4, b"up!\0")
    return b"II*\0\x08\0\0\0\x01\0" + entry + b"\0" * 4
