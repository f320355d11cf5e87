"""Values as text that is the same in every process, on every machine.

What is written here goes into the names of artifacts: `repr` would do for numbers, but
of a function it gives an address in memory, and of a set an order that is drawn anew
with every process.
"""

import dataclasses
import functools
import hashlib
import inspect
import re
from typing import Any, Final

import numpy as np

EXACT: Final = (type(None), bool, int, float, str, bytes)


def key_of(*parts: str) -> str:
    """Hash parts into a key; ("ab", "c") and ("a", "bc") differ."""
    joined = "\0".join(parts).encode()
    return hashlib.sha256(joined).hexdigest()[:40]


def stable(value: Any) -> str:  # noqa: PLR0911 - one for each kind
    """Write a value as text, which follows from what it is alone.

    A function or a class is written by its name; what it does is told by its code
    version, and its own defaults beside it.

    Raises:
        ValueError: if nothing but its place in memory tells it from others, as with a
            lambda or an object of a class that is no dataclass.
    """
    if type(value) in EXACT:
        return repr(value)
    if isinstance(value, (tuple, list)):
        return f"({', '.join(map(stable, value))})"
    if isinstance(value, (set, frozenset)):
        return f"set({', '.join(sorted(map(stable, value)))})"
    if isinstance(value, dict):  # its order may be what counts: the first that fits
        pairs = (f"{stable(k)}: {stable(v)}" for k, v in value.items())
        return f"{{{', '.join(pairs)}}}"
    if isinstance(value, (np.ndarray, np.generic)):
        return f"{value.dtype}{value.shape}{stable(value.tolist())}"
    if isinstance(value, re.Pattern):
        return f"re({value.pattern!r}, {value.flags})"
    if isinstance(value, functools.partial):
        return f"{stable(value.func)}{stable(value.args)}{stable(value.keywords)}"
    if inspect.isroutine(value) or inspect.isclass(value):
        return named(value)
    if dataclasses.is_dataclass(value):
        fields = {f.name: getattr(value, f.name) for f in dataclasses.fields(value)}
        return f"{named(type(value))}{stable(fields)}"
    raise ValueError(f"no text tells {value!r} from others in every process")


def named(value: Any) -> str:
    """Write where a function or a class is found.

    Raises:
        ValueError: if it has no name of its own.
    """
    whose = getattr(value, "__self__", None)
    if not (whose is None or inspect.ismodule(whose)):
        raise ValueError(f"{value!r} has no name of its own: it is bound to an object")
    name = f"{value.__module__}.{value.__qualname__}"
    if "<" in name:
        raise ValueError(f"{name} has no name of its own: define it in its module")
    return name
