"""Places to write to that are occupied, linked elsewhere, another's, or closed."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Final

from tests.hostile import networks, options
from tests.hostile.case import Case, Make
from tests.hostile.folders import filled
from tests.pipelines import painted

ROOT: Final = os.geteuid() == 0  # to whom nothing is forbidden
PROC: Final = "/proc/city"  # where not even root makes a folder


def indexed(spoil: Callable[[Path], object], city: str = "city") -> Make:
    """Index a good photograph into a spoiled place."""

    def make(folder: Path) -> list[object]:
        filled("5_1.png", painted.photo(), folder / "photos")
        spoil(folder)
        return ["index", "photos", "-o", city]

    return make


def explained(spoil: Callable[[Path], object], out: str = "out") -> Make:
    def make(folder: Path) -> list[object]:
        words = networks.explained(bool)(folder)
        spoil(folder)
        words[words.index("out")] = out
        return words

    return make


def built(spoil: Callable[[Path], object]) -> Make:
    def make(folder: Path) -> list[object]:
        words = options.built()(folder)
        spoil(folder)
        return [*words]

    return make


def occupied(name: str) -> Callable[[Path], object]:
    def spoil(folder: Path) -> None:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text("another's")

    return spoil


def folder_at(name: str) -> Callable[[Path], object]:
    return lambda folder: (folder / name / "within").mkdir(parents=True)


def linked(name: str, target: str) -> Callable[[Path], object]:
    """Put a link where something is written, to what must stay as it is."""

    def spoil(folder: Path) -> None:
        (folder / "kept").mkdir()
        (folder / "kept" / "file").write_text("another's")
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).symlink_to(target)

    return spoil


def closed(name: str) -> Callable[[Path], object]:
    return lambda folder: (folder / name).mkdir(mode=0o555)


def mended(folder: Path) -> None:
    (folder / "city").mkdir()
    (folder / "city" / "manifest.csv").write_text("photo,front_id,block,lot\n")


def sparse(folder: Path) -> None:
    (folder / "city").mkdir()
    with (folder / "city" / "manifest.csv").open("wb") as file:
        file.truncate(3 * 1024**3)


def record(text: str) -> Callable[[Path], object]:
    """Leave a site whose record of what is ours is damaged."""

    def spoil(folder: Path) -> None:
        (folder / "city" / "site").mkdir()
        (folder / "city" / "site" / "index.html").write_text("another's")
        (folder / "city" / "site" / ".nostalgin.json").write_text(text)

    return spoil


def cases() -> list[Case]:
    """List all hostile outputs."""
    return [*of_index(), *of_explain(), *of_build()]


def of_index() -> list[Case]:
    sound = {"code": 0, "writes": "city", "keeps": ("5_1.png",)}
    up = "../kept/file"
    return [
        Case("index: a file", indexed(occupied("city")), 1, ("city",)),
        Case("index: below a file", indexed(occupied("f"), "f/city"), 1, ("f/city",)),
        Case("index: nowhere", indexed(bool, PROC), 1, (PROC,)),
        Case("index: a device", indexed(bool, "/dev/null/city"), 1, ("/dev/null",)),
        Case("index: a long name", indexed(bool, "x" * 300), 1, ("xxx",)),
        Case("index: a page", indexed(bool, "http://127.0.0.1:9"), 1, ("http:",)),
        Case("index: closed", indexed(closed("city")), 1, ("city",)),
        Case("index: mended", indexed(mended), 1, ("--force",)),
        Case("index: sparse file of 3 GB", indexed(sparse), 1, ("manifest.csv",)),
        Case(
            "index: folder",
            indexed(folder_at("city/manifest.csv")),
            1,
            ("city",),
            "city",
        ),
        Case("index: link", indexed(linked("city/manifest.parquet", up)), **sound),
        Case("index: loop", indexed(linked("city/manifest.parquet", ".")), **sound),
        Case("index: a link to itself", indexed(linked("city", "city")), 1, ("city",)),
        Case(
            "index: a link to nowhere",
            indexed(linked("city", "no/where")),
            1,
            ("city",),
        ),
    ]


def of_explain() -> list[Case]:
    up, out = "../kept/file", "out"
    sound = {"code": 0, "writes": out}
    return [
        Case("explain: a file", explained(occupied("out")), 1, ("out",)),
        Case("explain: nowhere", explained(bool, PROC), 1, (PROC,)),
        Case("explain: closed", explained(closed("out")), 1, ("out",)),
        Case(
            "explain: folder", explained(folder_at("out/panel.png")), 1, ("out",), "out"
        ),
        Case(
            "explain: linked picture", explained(linked("out/panel.png", up)), **sound
        ),
        Case(
            "explain: linked record", explained(linked("out/explain.json", up)), **sound
        ),
        Case("explain: a link to itself", explained(linked("out", "out")), 1, ("out",)),
    ]


def of_build() -> list[Case]:
    foreign = "no record says"
    texts = ["", "{", "{}", "null", '["../x"]', "[1]", '["/x"]', "[" * 100_000, "\0"]
    up = {"writes": "city"}
    return [
        Case(
            "build: site of another",
            built(occupied("city/site/index.html")),
            1,
            (foreign,),
        ),
        Case("build: site a file", built(occupied("city/site")), 1, ("site",)),
        Case(
            "build: site a link",
            built(linked("city/site", "../kept")),
            1,
            ("is a link",),
        ),
        Case("build: runs a file", built(occupied("city/runs")), 1, ("city",)),
        Case(
            "build: run a link", built(linked("city/runs", "runs")), 1, ("city",), **up
        ),
        Case(
            "build: artifacts a file",
            built(occupied("city/artifacts")),
            1,
            ("city",),
            **up,
        ),
        *(
            Case(f"build: record {text[:9]!r}", built(record(text)), 1, (foreign,))
            for text in texts
        ),
    ]


def excused(name: str) -> str:
    """Tell why a case can't be had here, if so."""
    return "root may write all" if ROOT and name.endswith(": closed") else ""
