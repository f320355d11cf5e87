"""Folders of photographs in which more lies than photographs, or less."""

import contextlib
import os
import socket
import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

from tests.hostile.case import Case, Make
from tests.pipelines import painted

GOOD: Final = "5_1.png"
ODD: Final = ("fifo.jpg", "socket.jpg", "zero.jpg", "nowhere.jpg", "self.jpg")
WAITED: Final = "waited"  # the file that tells that somebody did
LONG_S: Final = 3.0  # for a pipe to be waited at
ROOT: Final = os.geteuid() == 0  # to whom nothing is forbidden


def indexed(spoil: Callable[[Path], object], *more: object) -> Make:
    """Spoil a folder with one good photograph, and index it."""

    def make(folder: Path) -> list[object]:
        photos = folder / "photos"
        photos.mkdir()
        (photos / GOOD).write_bytes(painted.photo())
        spoil(photos)
        return ["index", "photos", "-o", "city", *more]

    return make


def alone(spoil: Callable[[Path], object]) -> Make:
    """Let something hostile stand where a folder of photographs is wanted."""

    def make(folder: Path) -> list[object]:
        spoil(folder / "photos")
        return ["index", "photos", "-o", "city"]

    return make


def loop(photos: Path) -> None:
    (photos / "round").symlink_to(".")
    (photos / "up").symlink_to("..")
    (photos / "ping").symlink_to("pong")
    (photos / "pong").symlink_to("ping")


def linked(target: str, name: str = "linked.jpg") -> Callable[[Path], object]:
    return lambda photos: (photos / name).symlink_to(target)


def deep(levels: int, name: str, photos: Path) -> None:
    """Nest folders, deeper than a path may be long if need be."""
    here = os.open(photos, os.O_RDONLY)
    for _ in range(levels):
        os.mkdir(name, dir_fd=here)
        below = os.open(name, os.O_RDONLY, dir_fd=here)
        os.close(here)
        here = below
    os.close(os.open("7_1.png", os.O_CREAT | os.O_WRONLY, dir_fd=here))
    os.close(here)


def bound_socket(path: Path) -> None:
    """Make a socket, of which no path may be long."""
    before = Path.cwd()
    os.chdir(path.parent)
    try:
        with socket.socket(socket.AF_UNIX) as one:
            one.bind(path.name)
    finally:
        os.chdir(before)


def odd_files(photos: Path) -> None:
    os.mkfifo(photos / "fifo.jpg")
    bound_socket(photos / "socket.jpg")
    (photos / "folder.jpg").mkdir()
    (photos / "zero.jpg").symlink_to("/dev/zero")
    (photos / "nowhere.jpg").symlink_to("nowhere")
    (photos / "self.jpg").symlink_to("self.jpg")


def sparse(photos: Path, name: str = "sparse.jpg") -> None:
    with (photos / name).open("wb") as file:
        file.truncate(3 * 1024**3)


def filled(name: str, data: bytes, folder: Path) -> None:
    folder.mkdir()
    (folder / name).write_bytes(data)


def forbidden(photos: Path) -> None:
    (photos / "closed").mkdir()
    (photos / "closed" / "6_1.png").write_bytes(painted.photo())
    (photos / "closed").chmod(0)


def unspelt(folder: Path) -> list[object]:
    photos = Path(os.fsdecode(os.fsencode(folder) + b"/caf\xe9"))
    filled(GOOD, painted.photo(), photos)
    return ["index", photos.name, "-o", "city"]


def inside_site(folder: Path) -> list[object]:
    photos = folder / "city" / "site" / "photos"
    photos.mkdir(parents=True)
    (photos / GOOD).write_bytes(painted.photo())
    return ["index", photos, "-o", "city"]


def into_itself(folder: Path) -> list[object]:
    filled(GOOD, painted.photo(), folder / "photos")
    return ["index", "photos", "-o", "photos"]


def into_below(folder: Path) -> list[object]:
    """Index twice into a folder inside, where an earlier build left pictures."""
    filled(GOOD, painted.photo(), folder / "photos")
    site = folder / "photos" / "city" / "site" / "photos"
    site.mkdir(parents=True)
    (site / "thumbnail.png").write_bytes(painted.photo())
    return ["index", "photos", "-o", "photos/city"]


def cases() -> list[Case]:
    """List all hostile folders."""
    none = "holds no image"
    sound = {"code": 0, "writes": "city", "keeps": (GOOD,)}
    return [
        Case("loops of links", indexed(loop), says=("round", "up"), **sound),
        Case(
            "link to the whole disk",
            indexed(linked("/", "disk")),
            says=("disk",),
            **sound,
        ),
        Case("link to a photograph", indexed(linked(GOOD)), **sound),
        Case("link to nowhere", indexed(linked("nowhere")), says=("linked",), **sound),
        Case("link to memory", indexed(linked("/proc/self/mem")), **sound),
        Case("pipe, socket, device", indexed(odd_files), says=ODD, **sound),
        Case("sparse file of 3 GB", indexed(sparse), **sound),
        Case("nested 300 deep", indexed(partial(deep, 300, "d")), **sound),
        Case("nested 1100 deep", indexed(partial(deep, 1100, "d")), **sound),
        Case(
            "nested too deep",
            indexed(partial(deep, 40, "d" * 200)),
            says=("ddd",),
            **sound,
        ),
        Case("empty", alone(Path.mkdir), 1, (none, "photos")),
        Case("words alone", alone(partial(filled, "x.txt", b"")), 1, (none, "photos")),
        Case("suffix alone", alone(partial(filled, ".jpg", b"")), 1, (none, "photos")),
        Case("missing", alone(bool), 1, ("is no folder", "photos")),
        Case("a file", alone(Path.touch), 1, ("is no folder", "photos")),
        Case("a pipe", alone(os.mkfifo), 1, ("is no folder", "photos")),
        Case("a socket", alone(bound_socket), 1, ("is no folder", "photos")),
        Case(
            "a device",
            lambda _: ["index", "/dev/zero", "-o", "city"],
            1,
            ("/dev/zero",),
        ),
        Case("a link to itself", alone(round_link), 1, ("is no folder", "photos")),
        Case(
            "a name too long", lambda _: ["index", "x" * 300, "-o", "city"], 1, ("xxx",)
        ),
        Case("a name that is no text", unspelt, 1, ("caf\\xe9", "rename it")),
        Case("inside the site", inside_site, 1, ("is where build writes",)),
        Case("its own city", into_itself, 0, writes="photos", keeps=(GOOD,)),
        Case("city inside", into_below, 0, writes="photos/city", keeps=(GOOD,)),
        Case("a closed folder", indexed(forbidden), says=("closed",), **sound),
    ]


def pipe(path: Path) -> None:
    """Make a pipe, and after a while let go whoever waits at its other end.

    Who waits there in a library's code is not woken by the signal of a timeout.
    """
    os.mkfifo(path)
    one = threading.Timer(LONG_S, released, [path])
    one.daemon = True
    one.start()


def released(path: Path) -> None:
    with contextlib.suppress(OSError):
        other_end = os.open(path, os.O_WRONLY | os.O_NONBLOCK)  # fails if nobody waits
        path.with_name(WAITED).touch()  # before the other wakes
        os.close(other_end)


@dataclass(frozen=True)
class Unreadable:
    """What may stand where a photograph is wanted, and can't be read to its end."""

    name: str
    put: Callable[[Path], object]


def unreadable() -> list[Unreadable]:
    return [
        Unreadable("a pipe", pipe),
        Unreadable("a socket", bound_socket),
        Unreadable("a folder", Path.mkdir),
        Unreadable("a link to itself", round_link),
        Unreadable("an endless device", lambda path: path.symlink_to("/dev/zero")),
        Unreadable("a terminal", lambda path: path.symlink_to("/dev/tty")),
        Unreadable("memory", lambda path: path.symlink_to("/proc/self/mem")),
        Unreadable("nothing", bool),
        Unreadable("3 GB of holes", lambda path: sparse(path.parent, path.name)),
    ]


def round_link(path: Path) -> None:
    path.symlink_to(path.name)


def excused(name: str) -> str:
    """Tell why a case can't be had here, if so."""
    return "root may read all" if ROOT and name == "a closed folder" else ""
