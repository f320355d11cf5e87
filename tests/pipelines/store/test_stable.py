import os
import re
import subprocess
import sys
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import pytest

from pipelines.store.stable import stable
from tests.data import ROOT

PRESENT = """
import importlib, sys
for name in sys.argv[1:]:
    importlib.import_module(name)
from pipelines.models import Models
from pipelines.store.versions import Versions
print(Versions.present(Models()))
"""


@dataclass(frozen=True)
class Record:
    limit: float
    names: tuple[str, ...] = field(default=("a",))


class Plain:
    pass


def versions(seed: int, *first: str) -> str:
    """Name the versions in a fresh process that loads some modules first."""
    return subprocess.run(
        [sys.executable, "-c", PRESENT, *first],
        cwd=ROOT,
        env=os.environ | {"PYTHONHASHSEED": str(seed)},
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def test_versions_are_the_same_in_every_process_whatever_it_has_loaded() -> None:
    told = versions(0)
    assert told.startswith("Versions(segment='")
    assert versions(1) == told
    more = ("nostalgin_core.rectify.manhattan", "nostalgin_core.reconstruct")
    assert versions(2, *more) == told


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.1, "0.1"),
        (True, "True"),
        (None, "None"),
        ("a'b", '"a\'b"'),
        ((1, (2.5, "x")), "(1, (2.5, 'x'))"),
        ({"b": 1, "a": (2,)}, "{'b': 1, 'a': (2)}"),
        (frozenset({"one", "two", "three"}), "set('one', 'three', 'two')"),
        (np.array([[1.5, 2.0]]), "float64(1, 2)((1.5, 2.0))"),
        (np.float32(0.5), "float32()0.5"),
        (re.compile("a+", re.IGNORECASE), "re('a+', 34)"),
        (stable, "pipelines.store.stable.stable"),
        (dict, "builtins.dict"),
        (max, "builtins.max"),
        (partial(stable, 1), "pipelines.store.stable.stable(1){}"),
    ],
)
def test_a_value_is_written_by_what_it_is(value: Any, text: str) -> None:
    assert stable(value) == text


def test_a_record_is_written_by_its_fields() -> None:
    assert stable(Record(1.0)) == stable(Record(1.0))
    assert stable(Record(1.0)) != stable(Record(2.0))
    assert stable(Record(1.0)) != stable(Record(1.0, ("b",)))


def test_a_long_array_is_written_to_its_end() -> None:
    one, other = np.zeros(5000), np.zeros(5000)
    other[2500] = 1e-9
    assert repr(one) == repr(other)
    assert stable(one) != stable(other)


@pytest.mark.parametrize(
    "value", [lambda: 0, Plain(), (1, object()), {"a": Plain()}, {1: 2}.get]
)
def test_what_only_its_place_in_memory_tells_is_refused(value: object) -> None:
    with pytest.raises(ValueError, match=r"no text|no name of its own"):
        stable(value)
