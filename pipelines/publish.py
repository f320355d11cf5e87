"""Copy a city's site to a folder that any web host can serve."""

import errno
import os
import shutil
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from pipelines.site import Folder, Foreign, altered, recorded
from pipelines.view import site_of

LAST: Final = ("index.html", "site.json", "tileset.json")  # what names all others
AWAY: Final = "move it elsewhere, or name another folder"


@dataclass(frozen=True)
class Published:
    """What a copy of a site holds."""

    folder: Path
    files: int
    size: int  # bytes


def publish(city: Path, folder: Path) -> Published:
    """Copy what the current site needs, and nothing else.

    A new folder appears whole, in one move. One of an earlier publishing is replaced
    file by file, those that name others last; its visitors' files stay until the next
    time. What another wrote there is neither changed nor removed.

    Raises:
        NoSiteError: if the city has no site.
        Foreign: if the folder is another's, or the site's own, or a file of the site is
            gone.
        OSError: if it can't be written.
    """
    site = site_of(city)
    names = ordered(recorded(site)[0])
    gone = next((name for name in names if not (site / name).is_file()), None)
    if gone is not None:
        raise Foreign(f"{site / gone} is gone: run `nostalgin build {city}` again")
    target = folder.absolute()
    here = target.resolve()
    if here == site or site in here.parents or here in site.parents:
        raise Foreign(f"{folder} is the city's own: name a folder outside of it")
    if folder.exists() or folder.is_symlink():
        size = copied(site, names, target)
    else:
        target.parent.mkdir(parents=True, exist_ok=True)
        beside = target.with_name(f".{target.name}.{os.getpid()}.partial")
        try:
            size = copied(site, names, beside)
            moved(beside, target)
        finally:
            shutil.rmtree(beside, ignore_errors=True)
    return Published(folder, len(names), size)


def moved(beside: Path, target: Path) -> None:
    """Give a whole folder its name.

    Raises:
        Foreign: if another took the name meanwhile.
    """
    try:
        beside.rename(target)
    except OSError as problem:
        if problem.errno in (errno.EEXIST, errno.ENOTEMPTY, errno.ENOTDIR):
            raise Foreign(f"{target} was made meanwhile: {AWAY}") from problem
        raise


def copied(site: Path, names: Iterable[str], target: Path) -> int:
    """Copy files in order; return how many bytes they have.

    Raises:
        Foreign: if the folder, or a file in the way, is another's, or one of the site
            is damaged.
    """
    names = list(names)
    try:
        to = Folder(target, names)
    except Foreign as problem:
        raise Foreign(str(problem).replace("build again", "publish again")) from problem
    size = 0
    for name in names:
        data = (site / name).read_bytes()
        if altered(name, data):
            raise Foreign(f"{site / name} is damaged: run `nostalgin build` again")
        to.write(name, data)
        size += len(data)
    to.prune()
    return size


def ordered(names: Iterable[str]) -> list[str]:
    """Put files that name others behind these."""
    return sorted(names, key=lambda name: (name in LAST and LAST.index(name) + 1, name))
