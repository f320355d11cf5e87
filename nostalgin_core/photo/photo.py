"""A file's bytes become one gray, upright photo, or a rejection that names the remedy.

Archives hold what scanners and hands made of a hundred years: gray and colour, 8 and
16 bits, CMYK from the print shop, palettes, pages, turned by EXIF. All of these are
read. The size is read from the header, before a single pixel is decoded, so that no
file can claim more memory than the limit allows.
"""

import hashlib
import io
import struct
import warnings
import zlib
from collections.abc import Callable
from typing import Final

import numpy as np
from jaxtyping import Num, UInt8
from PIL import (
    BmpImagePlugin,
    GifImagePlugin,
    Image,
    ImageFile,
    Jpeg2KImagePlugin,
    JpegImagePlugin,
    PngImagePlugin,
    TiffImagePlugin,
    WebPImagePlugin,
)

from nostalgin_core.arrays import Gray
from nostalgin_core.photo import frame, page
from nostalgin_core.records import Photo, Rejection

MAX_MEGAPIXELS: Final = 150.0  # a 4x5 inch negative at 2,400 dpi has 115
MIN_SIDE_PX: Final = 64  # below this no facade has a window

PAGED: Final = ("TIFF", "GIF", "WEBP")  # formats of several pages, or frames

_READERS: Final[dict[bytes, Callable[..., ImageFile.ImageFile]]] = {
    b"\xff\xd8\xff": JpegImagePlugin.jpeg_factory,
    b"\x89PNG\r\n\x1a\n": PngImagePlugin.PngImageFile,
    b"II*\0": TiffImagePlugin.TiffImageFile,
    b"MM\0*": TiffImagePlugin.TiffImageFile,
    b"II+\0": TiffImagePlugin.TiffImageFile,
    b"MM\0+": TiffImagePlugin.TiffImageFile,
    b"RIFF": WebPImagePlugin.WebPImageFile,
    b"\0\0\0\x0cjP  ": Jpeg2KImagePlugin.Jpeg2KImageFile,
    b"\xff\x4f\xff\x51": Jpeg2KImagePlugin.Jpeg2KImageFile,
    b"GIF8": GifImagePlugin.GifImageFile,
    b"BM": BmpImagePlugin.BmpImageFile,
}

# What Pillow's readers raise on damaged bytes, each seen while fuzzing them.
_DAMAGE: Final = (
    OSError,
    SyntaxError,
    ValueError,
    EOFError,
    IndexError,
    KeyError,
    TypeError,
    OverflowError,
    struct.error,
    zlib.error,
    Image.DecompressionBombError,
)

_ORIENTATION_TAG: Final = 0x0112
_PHOTOMETRIC_TAG: Final = 262
_WHITE_IS_ZERO: Final = 0


def key(data: bytes) -> str:
    """Name a photo by its content: the first 16 hex digits of its SHA-256."""
    return hashlib.sha256(data).hexdigest()[:16]


class _RefusedError(Exception):
    """Carries a reason and a remedy up to `decode`, which makes a value of them."""


def decode(
    data: bytes, *, name: str, max_megapixels: float = MAX_MEGAPIXELS
) -> Photo | Rejection:
    """Read a photo as gray, upright, with its film border found.

    The first page of a file with several is read. A page with several prints on it is
    refused. `name` is the file's name as its
    owner knows it; it appears in rejections and nowhere else.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Pillow warns of odd metadata, unused here
            opened = _open(data)
            _check_size(*opened.size, max_megapixels=max_megapixels)
            image = _gray(opened)
    except _RefusedError as refused:
        reason, detail = refused.args
        return Rejection(key(data), "photo", reason, f"{name}: {detail}")
    if page.gutters(image):
        detail = "a stripe of page parts them; cut each out, and index them one by one"
        return Rejection(key(data), "photo", "several prints", f"{name}: {detail}")
    return frame.framed(key(data), image)


def paged(data: bytes) -> bool:
    """Tell whether a photo's file holds other pages than the first, which is read.

    A telephone's second picture beside the first is no page.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            opened = _open(data)
            if opened.format not in PAGED:
                return False
            opened.seek(1)
    except (_RefusedError, *_DAMAGE):
        return False
    return True


def size_px(data: bytes) -> tuple[int, int] | None:
    """Read an upright photo's width and height from its header; None if it has none."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            opened = _open(data)
            turned = _orientation(opened) > 4  # as `_upright` undoes them
    except _RefusedError:
        return None
    width, height = opened.size
    return (height, width) if turned else (width, height)


def _open(data: bytes) -> ImageFile.ImageFile:
    """Read the header alone.

    Pillow's own `open` refuses a large picture before it tells its size, and tries
    formats that run other programs.
    """
    if not data:
        detail = "holds no bytes; copy it again from its source"
        raise _RefusedError("empty file", detail)
    for magic, reader in _READERS.items():
        if data.startswith(magic):
            try:
                return reader(io.BytesIO(data), None)
            except _DAMAGE as damage:
                raise _RefusedError("damaged header", _words(damage)) from damage
    detail = (
        "its first bytes are those of no format read here; "
        "save the photo as JPEG, PNG or TIFF"
    )
    raise _RefusedError("not a picture", detail)


def _words(damage: BaseException) -> str:
    what = (str(damage) or type(damage).__name__).rstrip(".")
    return f"{what}; copy or scan the photo again"


def _check_size(width: int, height: int, *, max_megapixels: float) -> None:
    if width * height > max_megapixels * 1e6:
        detail = (
            f"{width} x {height} pixels, over the limit of {max_megapixels:g} "
            "megapixels; scale it down first"
        )
        raise _RefusedError("too large", detail)
    if min(width, height) < MIN_SIDE_PX:
        detail = (
            f"{width} x {height} pixels; each side needs at least {MIN_SIDE_PX}; "
            "use a larger scan"
        )
        raise _RefusedError("too small", detail)


def _gray(opened: ImageFile.ImageFile) -> Gray:
    try:
        if opened.mode in {"RGB", "YCbCr"}:
            opened.draft("L", opened.size)  # a JPEG then decodes its luma alone
        opened.load()
        image = _levels(opened)
    except (*_DAMAGE, MemoryError) as damage:
        raise _RefusedError("damaged pixels", _words(damage)) from damage
    return np.ascontiguousarray(_upright(image, _orientation(opened)))


def _levels(opened: ImageFile.ImageFile) -> Gray:
    """Bring any of Pillow's modes to 8 bits of gray."""
    if opened.mode == "F" or opened.mode.startswith("I"):
        deep = _eight_bits(np.asarray(opened))
        return 255 - deep if _inverted(opened) else deep
    if opened.mode == "LAB":
        return np.asarray(opened.getchannel("L"))
    if opened.has_transparency_data:
        paper = Image.new("RGBA", opened.size, "white")
        return np.asarray(
            Image.alpha_composite(paper, opened.convert("RGBA")).convert("L")
        )
    if opened.mode == "CMYK":
        return np.asarray(opened.convert("RGB").convert("L"))
    return np.asarray(opened.convert("L"))


def _inverted(opened: ImageFile.ImageFile) -> bool:
    """Tell a deep TIFF in which white is zero; Pillow turns only the 8-bit ones."""
    tags = getattr(opened, "tag_v2", {})
    return tags.get(_PHOTOMETRIC_TAG) == _WHITE_IS_ZERO


def _eight_bits(deep: Num[np.ndarray, "h w"]) -> Gray:
    """Scale deep pixels to 0..255, by the depth that was used or else by their range.

    A 12-bit scanner writes 0..4095 into 16-bit files: the full scale is the least of
    8, 10, 12, 14 and 16 bits that holds the brightest pixel. Anything else (floats,
    signs, 32 bits) is stretched between its least and its greatest finite value.
    """
    finite = np.where(np.isfinite(deep), deep, 0)
    low, high = float(finite.min()), float(finite.max())
    depths = [2.0**bits - 1 for bits in (8, 10, 12, 14, 16)]
    whole = np.issubdtype(deep.dtype, np.integer)
    if whole and low >= 0 and high <= depths[-1]:
        low, high = 0.0, next(depth for depth in depths if depth >= high)
    scale = 255.0 / (high - low) if high > low else 0.0
    return np.round((finite.astype(np.float32) - low) * scale).astype(np.uint8)


def _orientation(opened: ImageFile.ImageFile) -> int:
    """Read the EXIF orientation, 1 where there is none or it cannot be read."""
    try:
        return int(opened.getexif().get(_ORIENTATION_TAG, 1))
    except _DAMAGE:
        return 1


def _upright(image: Gray, orientation: int) -> UInt8[np.ndarray, "upright_h upright_w"]:
    """Undo an EXIF orientation (Exif 2.32, tag 274)."""
    turns: dict[int, Callable[[np.ndarray], np.ndarray]] = {
        2: np.fliplr,
        3: lambda a: np.rot90(a, 2),
        4: np.flipud,
        5: np.transpose,
        6: lambda a: np.rot90(a, -1),
        7: lambda a: np.rot90(a, 2).T,
        8: np.rot90,
    }
    return turns.get(orientation, lambda a: a)(image)
