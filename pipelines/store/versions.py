"""What a stage's results depend on beside its input: its code and its parameters.

    <code version>-<hash of the parameters and of the network>

The code version is raised by hand when a stage's results change; a comment or a rename
must not send an archive back to its first photo. The parameters are the defaults in the
signatures of the functions and the constants of the modules behind what the stage's
room hands on, and of all modules of the core that these use, so that a changed one
can't be forgotten.
"""

import inspect
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any, Final, Self

from nostalgin_core import block, inpaint, matte, model, photo, rectify, segment
from pipelines.models import NETWORKS, Models
from pipelines.store.store import ARTIFACTS, key_of

CODE: Final = {
    "segment": 5,
    "matte": 7,
    "rectify": 4,
    "inpaint": 5,
    "block": 2,
    "thumbnail": 1,
}
ROOMS: Final[dict[str, tuple[ModuleType, ...]]] = {
    "segment": (photo, segment),
    "matte": (matte,),
    "rectify": (rectify,),
    "inpaint": (inpaint,),
    "block": (block, model),
    "thumbnail": (photo,),
}
CORE: Final = "nostalgin_core."
PLAIN: Final = (bool, int, float, str, tuple)
COUNTED: Final = ("segment", "matte", "rectify", "inpaint", "block")


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
            if inspect.isfunction(one) and one.__module__ == module.__name__:
                told += [[name, *default] for default in defaults(one)]
            elif name.isupper() and isinstance(one, PLAIN):
                told.append([module.__name__, name, repr(one)])
    return json.dumps(told)


def defaults(function: Callable[..., Any]) -> list[list[str]]:
    """List the defaults in a signature."""
    return [
        [name, repr(one.default)]
        for name, one in inspect.signature(function).parameters.items()
        if one.default is not inspect.Parameter.empty
    ]


def version(stage: str, models: Models) -> str:
    """Name the version of a stage as it is now.

    Raises:
        Unlocked: if the stage's network has no lock.
    """
    network = models.sha256(stage) if stage in NETWORKS else ""
    return f"{CODE[stage]}-{key_of(parameters(*ROOMS[stage]), network)[:8]}"


@dataclass(frozen=True)
class Versions:
    """The versions of all stages in one run, and so the names of all artifacts."""

    segment: str
    matte: str
    rectify: str
    inpaint: str
    block: str
    thumbnail: str

    @classmethod
    def present(cls, models: Models) -> Self:
        """Name the versions of all stages as they are now.

        Raises:
            Unlocked: if a network has no lock.
        """
        return cls(**{stage: version(stage, models) for stage in CODE})

    def key(self, stage: str, *made_from: str) -> str:
        """Make an artifact's key from the keys of what it is made from."""
        return key_of(stage, getattr(self, stage), *made_from)

    def path(self, stage: str, key: str) -> str:
        """Name an artifact, relative to the city folder."""
        return f"{ARTIFACTS}/{stage}/{getattr(self, stage)}/{key[:2]}/{key}.parquet"

    def segment_key(self, sha256: str) -> str:
        """Key what the network found in a photo."""
        return self.key("segment", sha256)

    def thumbnail_key(self, sha256: str) -> str:
        """Key a photo's small picture."""
        return self.key("thumbnail", sha256)

    def matte_key(self, sha256: str) -> str:
        """Key the matted facades of a photo."""
        return self.key("matte", self.segment_key(sha256))

    def rectify_key(self, sha256: str) -> str:
        """Key the elevations of a photo."""
        return self.key("rectify", self.matte_key(sha256))

    def inpaint_key(self, sha256: str, facade: int) -> str:
        """Key one finished elevation."""
        return self.key("inpaint", self.rectify_key(sha256), str(facade))

    def counts(self, root: str) -> dict[str, int]:
        """Count the artifacts of each stage in a city folder on this machine."""
        top = Path(root) / ARTIFACTS
        folders = {stage: top / stage / getattr(self, stage) for stage in COUNTED}
        return {
            stage: sum(1 for _ in folder.glob("*/*.parquet"))
            for stage, folder in folders.items()
        }
