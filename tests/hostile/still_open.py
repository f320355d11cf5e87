"""Cases of which something else comes out than must, each with its reason.

A case that is listed here and passes fails its test: it is no longer open.
"""

from typing import Final

OF_REASON: Final[dict[str, tuple[str, ...]]] = {
    "the manifest's reader strips blanks off a name": (
        "name: blank at the start",
        "name: blanks around a folder",
        "name: only a blank",
        "name: tab at the start",
        "name: line break at the start",
        "name: form feed at the start",
        "name: no-break space at the start",
        "name: ideographic space at the start",
    ),
    "a name like another system's path is refused where a disk allows it": (
        "name: drive",
        "name: backslash and dots",
        "name: backslash at the start",
        "catalogue row: backslashes upwards",
        "catalogue row: share",
        "catalogue row: drive",
        "manifest row: photo '..\\\\nowhere.jpg'",
        "manifest row: photo 'c:nowhere.jpg'",
    ),
    "a manifest may send this machine to hosts of its choice": (
        "manifest row: root 'http://127.0.0.1:9'",
        "manifest row: root 'ftp://127.0.0.1'",
        "manifest row: root 'foo://x'",
        "manifest row: root 'HTTP://x'",
    ),
    "one long cell refuses the whole list": (
        "catalogue: cell of 10 MB",
        "catalogue: column of 10 MB",
    ),
    "reading has no bounds": (
        "catalogue: pipe",
        "catalogue: endless device",
        "catalogue: sparse file of 3 GB",
        "manifest: sparse file of 3 GB",
        "photo: a pipe",
        "photo: an endless device",
        "photo: 3 GB of holes",
        "network: lock: sparse file of 3 GB",
        "network: file: sparse file of 3 GB",
        "output: index: sparse file of 3 GB",
    ),
    "folders are walked by recursion": (
        "folder: nested 1100 deep",
        "folder: nested too deep",
    ),
    "what is no regular file is passed over in silence": (
        "folder: loops of links",
        "folder: link to the whole disk",
        "folder: link to nowhere",
        "folder: pipe, socket, device",
    ),
    "the city folder is blamed": ("folder: a name too long",),
    "text is not checked to be UTF-8": (
        "manifest: Parquet: text that is no UTF-8",
        "manifest: Parquet: photo no UTF-8",
    ),
    "a lock nested deep ends the parser": (
        "network: lock: nested 100,000 deep",
        "network: lock: nested and closed",
    ),
    "what the runtime can't load raises": (
        "network: relocked: empty",
        "network: relocked: cut in half",
        "network: relocked: zeros",
        "network: relocked: words",
        "network: relocked: zeros within",
        "network: relocked: numbers of another file",
        "network: relocked: an unknown step",
        "network: relocked: a step of a stranger",
        "network: relocked inpaint: cut in half",
    ),
    "what a network asks and answers is not checked": (
        "network: relocked: two inputs",
        "network: relocked: one output",
        "network: relocked: boxes of three",
        "network: relocked: more boxes than scores",
        "network: relocked: masks flat",
        "network: relocked inpaint: one input",
        "network: relocked: boxes no numbers",
        "network: relocked: labels of nothing",
    ),
    "the runner is asked only when the pipeline is made": (
        "option: runner at a dead end",
        "option: runner without its extra",
    ),
    "bytes that are no UTF-8 are not refused": (
        "option: bytes for a credit",
        "option: bytes for networks",
    ),
    "a loop of links raises as the city folder is resolved": (
        "output: index: a link to itself",
    ),
    "no checksum vouches for an artifact": (
        "fuzz: artifact bytes",
        "artifact: 64 zeros at 0%",
        "artifact: 64 zeros at 30%",
        "artifact: a bit at 10%",
        "artifact: a bit at 45%",
        "artifact: a bit at 99%",
        "artifact: another schema",
        "artifact: other types",
        "artifact: no rows",
        "artifact: a false verdict",
        "artifact: twice itself",
        "artifact: a damaged city is built as it was",
    ),
    "an artifact does not say of what it was made": (
        "artifact: of another photograph",
    ),
    "cells are written as they are": ("formula: formula",),
    "a folder that no system can name is a crash": ("manifest row: root '\\x00'",),
}
OPEN: Final = {case: why for why, cases in OF_REASON.items() for case in cases}
