"""Loads Beam without what it would load for others: clients of stores and of Google.

Each of a run's processes would load them, and none has a use for them; Beam itself goes
on where they are not installed. What Beam and SciPy insist on, and a run asks nothing
of, has a stand-in that loads it when somebody does. Afterwards all can be had again.
(City folders in buckets are reached by Arrow.)
"""

import importlib
import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType
from typing import Any, Final

import numpy as np

UNUSED: Final = ("boto3", "bson", "pymongo", "apache_beam.io.gcp.bigquery")
LATE: Final = ("httplib2", "proto")
FORTRAN: Final = "numpy.f2py"  # which SciPy loads with all that NumPy has
HINTS: Final = "beartype"  # by which Beam compares the rarest of type hints


@contextmanager
def without(*names: str) -> Iterator[None]:
    """Let modules that are not loaded yet be taken for not installed."""
    before = logging.root.manager.disable
    logging.disable(logging.WARNING)  # Beam tells what lacks
    try:
        # None: as `import` takes what is not there
        with standing(dict.fromkeys(names)):
            yield
    finally:
        logging.disable(before)


@contextmanager
def standing(modules: dict[str, Any]) -> Iterator[None]:
    """Let others stand in the place of modules that are not loaded yet."""
    known: dict[str, Any] = sys.modules
    mine = {name: one for name, one in modules.items() if name not in known}
    known.update(mine)
    try:
        yield
    finally:
        for name in mine:
            del known[name]


class Late(ModuleType):
    """Stands in for a module, and loads it when something of it is asked for."""

    def __getattr__(self, name: str) -> Any:
        """Give what the module itself has; of what `import` asks, nothing."""
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(importlib.import_module(self.__name__), name)


@contextmanager
def late(*names: str) -> Iterator[None]:
    """Let modules that are not loaded yet be loaded only when they are used."""
    with standing({name: Late(name) for name in names}):
        yield


@contextmanager
def fortran_late() -> Iterator[None]:
    """Let what NumPy has for Fortran be loaded only when it is used."""
    with late(FORTRAN):
        own = sys.modules[FORTRAN]
        np.f2py = own  # as `import` does
        try:
            yield
        finally:
            if isinstance(own, Late):
                del np.f2py


@contextmanager
def hints_late() -> Iterator[None]:
    """Let Beam load beartype when it first compares two type hints by it."""
    names = [HINTS, f"{HINTS}.door", f"{HINTS}.roar"]
    package, door, roar = map(ModuleType, names)

    def is_subhint(sub: Any, base: Any) -> bool:
        known: Any = importlib.import_module(names[1])
        typehints: Any = importlib.import_module("apache_beam.typehints.typehints")
        typehints.is_subhint = known.is_subhint
        unknown: Any = importlib.import_module(names[2])
        typehints.BeartypeDoorException = unknown.BeartypeDoorException
        return known.is_subhint(sub, base)

    vars(door).update(is_subhint=is_subhint)
    vars(roar).update(BeartypeDoorException=())  # nothing is raised before it is known
    all_three = dict(zip(names, (package, door, roar), strict=True))
    with standing({} if HINTS in sys.modules else all_three):
        yield


with without(*UNUSED), late(*LATE), hints_late(), fortran_late():
    import apache_beam as apache_beam  # noqa: PLC0414 - it is loaded, not used
    from scipy import sparse  # noqa: F401 - the same
