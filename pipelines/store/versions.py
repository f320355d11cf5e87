"""What a stage's results depend on beside its input: its code and its parameters.

    <code version>-<hash of the parameters and of the network>

The code version is raised by hand when a stage's results change; a comment must not
send an archive back to its first photo (a constant that moves or is renamed does). The
parameters are the defaults in the signatures of the functions and the constants of the
modules behind what the stage's room hands on, and of all modules of the core that these
use, so that a changed one can't be forgotten.
"""

import dataclasses
import inspect
import json
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from importlib.metadata import version as release
from pathlib import Path
from types import ModuleType
from typing import Any, Final, Self

from nostalgin_core import (
    block,
    borrow,
    inpaint,
    matte,
    model,
    photo,
    placard,
    rectify,
    segment,
    storeys,
    views,
)
from pipelines.models import NETWORKS, PRINT, READER, Models
from pipelines.store.shelf import PACKED
from pipelines.store.stable import key_of, stable
from pipelines.store.store import ARTIFACTS

CODE: Final = {
    "segment": 12,
    "matte": 7,
    "rectify": 12,
    "compare": 2,
    "inpaint": 6,
    "block": 10,
    "thumbnail": 2,
    "borrow": 5,
    "placard": 1,
}
ROOMS: Final[dict[str, tuple[ModuleType, ...]]] = {
    "segment": (photo, segment),
    "matte": (matte,),
    "rectify": (rectify, storeys),
    "compare": (views,),
    "inpaint": (inpaint,),
    "block": (block, model),
    "thumbnail": (photo,),
    "borrow": (borrow,),
    "placard": (placard,),
}
CORE: Final = "nostalgin_core."
MARKED: Final = "rectify"  # the stage that takes a known watermark off
COUNTED: Final = ("segment", "matte", "rectify", "borrow", "inpaint", "block")


def family(*modules: ModuleType) -> list[ModuleType]:
    """List modules of the core and all others of the core that they use, by name."""
    found: dict[str, ModuleType] = {}
    waiting = list(modules)
    while waiting:
        module = waiting.pop()
        if module.__name__ in found:
            continue
        found[module.__name__] = module
        for one in told_of(module).values():
            home = one.__name__ if inspect.ismodule(one) else origin(one)
            if home.startswith(CORE):
                waiting.append(sys.modules[home])
    return [found[name] for name in sorted(found)]


def told_of(module: ModuleType) -> dict[str, object]:
    """List what counts of a module: all, but of a room what it hands on.

    What else hangs on a room are its modules, as far as this process has loaded them.
    """
    names = getattr(module, "__all__", vars(module))
    return {name: vars(module)[name] for name in names}


def origin(one: object) -> str:
    """Name the module that a function or class was written in."""
    home = getattr(one, "__module__", None)
    return home if isinstance(home, str) else ""


def parameters(*modules: ModuleType) -> str:
    """Write the constants of modules and the defaults of their functions as text."""
    told = []
    for module in family(*modules):
        for name, one in sorted(told_of(module).items()):
            own = origin(one) == module.__name__
            if own and (inspect.isfunction(one) or inspect.isclass(one)):
                told += [[module.__name__, name, *each] for each in defaults(one)]
            elif name.isupper():
                told.append([module.__name__, name, stable(one)])
    return json.dumps(told)


def defaults(one: Callable[..., Any]) -> list[list[str]]:
    """List the defaults in the signature of a function, or of a record."""
    if inspect.isfunction(one):
        given = inspect.signature(one).parameters.values()
        told = [(each.name, each.default) for each in given]
    elif dataclasses.is_dataclass(one):
        fields = dataclasses.fields(one)
        told = [(each.name, each.default) for each in fields]
        told += [(each.name, each.default_factory) for each in fields]
    else:
        told = []
    none = {id(inspect.Parameter.empty), id(dataclasses.MISSING)}
    return [[name, stable(each)] for name, each in told if id(each) not in none]


# Made as the module is loaded, so that a value without a stable text is told at once.
PARAMETERS: Final = {stage: parameters(*rooms) for stage, rooms in ROOMS.items()}


def version(stage: str, models: Models, mark: str = "") -> str:
    """Name the version of a stage as it is now, with the hash of what it takes off.

    Raises:
        Unlocked: if the stage's network has no lock.
    """
    network = models.sha256(stage) if stage in NETWORKS else ""
    network = release(PRINT) if stage == READER else network
    taken_off = [mark] if mark and stage == MARKED else []
    return f"{CODE[stage]}-{key_of(PARAMETERS[stage], network, *taken_off)[:8]}"


@dataclass(frozen=True)
class Versions:
    """The versions of all stages in one run, and so the names of all artifacts."""

    segment: str
    matte: str
    rectify: str
    inpaint: str
    block: str
    thumbnail: str
    borrow: str = ""  # runs of older cities had none
    # No block hangs on it, and a run's record of earlier days names none.
    placard: str = field(default="", compare=False)
    compare: str = ""  # of a run before there was one

    @classmethod
    def present(cls, models: Models, *, mark: str = "") -> Self:
        """Name the versions of all stages as they are now.

        `mark` is the hash of the watermark that is taken off, if one is.

        Raises:
            Unlocked: if a network has no lock.
        """
        return cls(**{stage: version(stage, models, mark) for stage in CODE})

    def key(self, stage: str, *made_from: str) -> str:
        """Make an artifact's key from the keys of what it is made from."""
        return key_of(stage, getattr(self, stage), *made_from)

    def path(self, stage: str, key: str) -> str:
        """Name an artifact, relative to the city folder."""
        return f"{self.folder(stage)}/{key[:2]}/{key}.parquet"

    def folder(self, stage: str) -> str:
        """Name the folder of a stage's artifacts, relative to the city folder."""
        return f"{ARTIFACTS}/{stage}/{getattr(self, stage)}"

    def segment_key(self, sha256: str) -> str:
        """Key what the network found in a photo."""
        return self.key("segment", sha256)

    def thumbnail_key(self, sha256: str) -> str:
        """Key a photo's small picture."""
        return self.key("thumbnail", sha256)

    def placard_key(self, sha256: str) -> str:
        """Key what is read of a photo's board, which is sought where segments are."""
        return self.key("placard", self.segment_key(sha256))

    def matte_key(self, sha256: str, outline: str = "") -> str:
        """Key the matted facades of a photo, one of them by its outline if drawn."""
        drawn = [outline] if outline else []
        return self.key("matte", self.segment_key(sha256), *drawn)

    def rectify_key(self, sha256: str, outline: str = "", quad: str = "") -> str:
        """Key the elevations of a photo, one of them by its quad if that is drawn."""
        drawn = [quad] if quad else []
        return self.key("rectify", self.matte_key(sha256, outline), *drawn)

    def borrow_key(self, elevations: Iterable[tuple[str, int]]) -> str:
        """Key an elevation and what lends to it: keys of `rectify`, and facades."""
        parts = (str(part) for one in elevations for part in one)
        return self.key("borrow", *parts)

    def inpaint_key(
        self, sha256: str, facade: int, outline: str = "", quad: str = ""
    ) -> str:
        """Key one finished elevation."""
        rectified = self.rectify_key(sha256, outline, quad)
        return self.key("inpaint", rectified, str(facade))

    def lent_key(self, borrowed: str) -> str:
        """Key a finished elevation to which others lent."""
        return self.key("inpaint", borrowed)

    def counts(self, root: str) -> dict[str, int]:
        """Count the artifacts of each stage in a city folder on this machine."""
        top = Path(root) / ARTIFACTS
        folders = {stage: top / stage / getattr(self, stage) for stage in COUNTED}
        return {stage: counted(folder) for stage, folder in folders.items()}


def counted(folder: Path) -> int:
    """Count the artifacts in a folder: a pack's name tells how many it holds."""
    names = (path.relative_to(folder).as_posix() for path in folder.glob("*/*.parquet"))
    packs = (PACKED.fullmatch(name) for name in names)
    return sum(int(one[1]) if one else 1 for one in packs)
