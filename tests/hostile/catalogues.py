"""Lists of photographs as hands, spreadsheets and other programs leave them."""

import os
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Final

from tests.hostile.case import Case, Make
from tests.hostile.folders import bound_socket, filled, round_link
from tests.pipelines import painted

GOOD: Final = "5_1.png"
HEAD: Final = "photo,block,lot,street,address,width_m\n"
ROW: Final = "5_1.png,5,1,Elm Street,1,10\n"
TABLE: Final = HEAD + ROW


@dataclass(frozen=True)
class HostileRow:
    """Cells of one row, and why it is rejected; no reason if it is a front."""

    called: str
    cells: dict[str, str]
    reason: str = ""


def indexed(data: bytes) -> Make:
    """Index one good photograph with a hostile list."""
    return with_list(lambda path: path.write_bytes(data))


def with_list(write: Callable[[Path], object]) -> Make:
    def make(folder: Path) -> list[object]:
        filled(GOOD, painted.photo(), folder / "photos")
        write(folder / "list.csv")
        return ["index", "photos", "--catalogue", "list.csv", "-o", "city"]

    return make


def workbook() -> bytes:
    sink = BytesIO()
    with zipfile.ZipFile(sink, "w") as file:
        file.writestr("xl/workbook.xml", "<workbook/>")
    return sink.getvalue()


def sparse(path: Path) -> None:
    with path.open("wb") as file:
        file.write(TABLE.encode())
        file.truncate(3 * 1024**3)


def broken() -> dict[str, tuple[bytes, str]]:
    """List tables that can't be read at all, with what is told of each."""
    cell = "a" * 10_000_000
    utf8, no_row = "save it as CSV in UTF-8", "no row that makes"
    unknown = "no column that is known"
    return {
        "UTF-16, cut": (TABLE.encode("utf-16")[:-1], utf8),
        "two encodings": ("Stra\u00dfe\n".encode() + b"Caf\xe9\n", "mend that line"),
        "no sign of Windows": (TABLE.encode() + b"Caf\x81\n", utf8),
        "nothing": (b"", no_row),
        "a mark alone": (b"\xef\xbb\xbf", no_row),
        "line breaks alone": (b"\n\r\n\n" * 99, no_row),
        "zeros": (bytes(4096), ""),
        "columns alone": (HEAD.encode(), no_row),
        "no column known": (b"a,b\n1,2\n", unknown),
        "no columns": (ROW.encode().replace(b"1,10", b"3,10") * 2, unknown),
        "block missing": (b"photo,lot\nx.png,1\n", "no block"),
        "lot missing": (b"photo,block\nx.png,1\n", "no lot"),
        "twin columns": (f"photo,{TABLE}".encode(), "two columns 'photo'"),
        "unclosed quote": ((TABLE + '5_2.png,5,2,"Elm\n').encode(), "is no CSV"),
        "letters after a quote": ((TABLE + '"5"_2.png,5,2\n').encode(), "is no CSV"),
        "unclosed quote of 10 MB": ((TABLE + f'"{cell}').encode(), "is no CSV"),
        "bars": (TABLE.replace(",", "|").encode(), "save it with commas"),
        "page": (b"<!DOCTYPE html><html><body>404</body></html>\n", unknown),
        "picture": (painted.photo(), utf8),
        "workbook": (workbook(), ""),
        "object": (b'{"photo": "5_1.png", "block": 5, "lot": 1}\n', unknown),
        "program": (b"\x7fELF\x02\x01\x01" + bytes(range(256)), utf8),
    }


def foreign() -> dict[str, bytes]:
    """List tables in other encodings: a list is read in them, a manifest is not."""
    return {
        "UTF-16": TABLE.encode("utf-16"),
        "UTF-16, big end first": b"\xfe\xff" + TABLE.encode("utf-16-be"),
        "UTF-16 without a mark": TABLE.encode("utf-16-le"),
        "UTF-32": TABLE.encode("utf-32"),
        "Latin-1": (TABLE + "5_2.png,5,2,Caf\u00e9\n").encode("latin-1"),
        "surrogates": TABLE.encode() + b"\xed\xa0\x80,5,2\n",
        "cut within a letter": TABLE.encode() + b"5_2.png,5,2,Caf\xc3",
    }


def sound() -> dict[str, bytes]:
    """List tables that are odd, and read all the same."""
    wide = ",".join(f"c{n}" for n in range(2000))
    cell = "a" * 10_000_000
    return {
        "mark at the start": b"\xef\xbb\xbf" + TABLE.encode(),
        "two marks at the start": b"\xef\xbb\xbf" * 2 + TABLE.encode(),
        "semicolons": TABLE.replace(",", ";").encode(),
        "tabs": TABLE.replace(",", "\t").encode(),
        "line ends of another system": TABLE.replace("\n", "\r").encode(),
        "both line ends": TABLE.replace("\n", "\r\n").encode(),
        "no line end": TABLE.rstrip().encode(),
        "all quoted": ('"' + TABLE.strip().replace(",", '","'))
        .replace("\n", '"\n"')
        .encode()
        + b'"',
        "column without a name": ("," + TABLE.replace("\n5", "\n,5")).encode(),
        "2000 more columns": TABLE.replace("_m\n", f"_m,{wide}\n").encode(),
        "5000 empty lines": TABLE.encode() + b"\n" * 5000,
        "20,000 commas": TABLE.encode() + b"," * 20_000,
        "columns in capitals": (HEAD.upper() + ROW).encode(),
        "cell of 10 MB": (TABLE + f"5_2.png,5,2,{cell}\n").encode(),
        "column of 10 MB": (f"{cell}," + TABLE.replace("\n5", "\n,5")).encode(),
        "a row twice": (TABLE + ROW).encode(),
    }


def odd_files() -> dict[str, tuple[Callable[[Path], object], str]]:
    """List what may stand where a list is wanted and is no file of bytes."""
    return {
        "missing": (bool, "name a CSV file"),
        "folder": (Path.mkdir, "name a CSV file"),
        "pipe": (os.mkfifo, ""),
        "socket": (bound_socket, ""),
        "link to itself": (round_link, ""),
        "empty device": (lambda path: path.symlink_to("/dev/null"), ""),
        "endless device": (lambda path: path.symlink_to("/dev/zero"), ""),
        "memory": (lambda path: path.symlink_to("/proc/self/mem"), ""),
        "sparse file of 3 GB": (sparse, ""),
    }


def cases() -> list[Case]:
    """List all hostile catalogues."""
    return [
        *(
            Case(name, indexed(data), 1, ("list.csv", said))
            for name, (data, said) in broken().items()
        ),
        *(
            Case(name, indexed(data), 0, writes="city", keeps=(GOOD,))
            for name, data in (sound() | foreign()).items()
        ),
        *(
            Case(name, with_list(write), 1, ("list.csv", said))
            for name, (write, said) in odd_files().items()
        ),
    ]


def rows() -> list[HostileRow]:
    """List hostile rows, which one list holds beside a good one."""
    return [*numbers(), *places(), *captions()]


def numbers() -> list[HostileRow]:
    nonsense = "nan inf -inf 1e999 -5 0 401 1e2 0x10 10m 1_0 1940-01-01 =1+1".split()  # noqa: SIM905
    nonsense += ["1,500", "9" * 5000, "\u221e", "ten"]
    width = [
        HostileRow(f"width {cell[:12]}", {"width_m": cell}, "nonsense width_m")
        for cell in nonsense
    ]
    others = [("ring", "100"), ("ring", "1.5"), ("side", "-1"), ("order", "nan")]
    return [
        *width,
        HostileRow("width of wide digits", {"width_m": "\uff11\uff10"}),
        HostileRow("width of blanks", {"width_m": " \u00a0 "}),
        *(
            HostileRow(f"{name} {cell}", {name: cell}, f"nonsense {name}")
            for name, cell in others
        ),
    ]


def places() -> list[HostileRow]:
    outside, nonsense = "path outside the photo folder", "nonsense block or lot"
    return [
        HostileRow("path from the root", {"photo": "/etc/passwd.jpg"}, outside),
        HostileRow("path upwards", {"photo": "../../x.jpg"}, outside),
        HostileRow("path upwards within", {"photo": "a/../../x.jpg"}, outside),
        HostileRow("backslashes upwards", {"photo": "..\\x.jpg"}),
        HostileRow("share", {"photo": "\\\\host\\x.jpg"}),
        HostileRow("drive", {"photo": "c:x.jpg"}),
        HostileRow("zero in a path", {"photo": "x\0.jpg"}, outside),
        HostileRow("address", {"photo": "http://127.0.0.1:9/x.jpg"}),
        HostileRow("block upwards", {"block": "../../x"}, nonsense),
        HostileRow("block with a slash", {"block": "a/b"}, nonsense),
        HostileRow("block with a zero", {"block": "a\0b"}, nonsense),
        HostileRow("long block", {"block": "b" * 200}, nonsense),
        HostileRow("no block", {"block": ""}, "no block"),
        HostileRow("blanks for a lot", {"lot": " \t"}, "no lot"),
        HostileRow("too many cells", {"beyond": "Manhattan"}, "too many cells"),
    ]


def captions() -> list[HostileRow]:
    return [
        HostileRow("Hebrew", {"street": "\u05e8\u05d7\u05d5\u05d1 \u202eElm"}),
        HostileRow("10,000 letters", {"street": "Elm " * 2500}),
        HostileRow("page", {"street": "<img src=x onerror=alert(1)>"}),
        HostileRow("formula", {"street": '=HYPERLINK("http://x","y")'}),
        HostileRow("formula with at", {"credit": "@SUM(1+1)*cmd|' /C calc'!A0"}),
        HostileRow("escape of the terminal", {"credit": "\x1b]0;x\a\x1b[2J"}),
        HostileRow("markup of the console", {"street": "[/red]Elm[bold"}),
        HostileRow("address of numbers", {"address": "9" * 400}),
        HostileRow("address of dashes", {"address": "1-" * 2000}),
        HostileRow("line breaks", {"street": "Elm\r\nStreet\n\n"}),
        HostileRow("zeros", {"street": "Elm\0Street"}),
    ]
