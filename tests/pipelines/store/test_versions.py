import types
from dataclasses import replace
from pathlib import Path

import pytest

from nostalgin_core import matte
from pipelines.models import Models, Unlocked
from pipelines.store import versions
from pipelines.store.versions import Versions
from tests.pipelines import painted

MADE = Versions("s1", "m1", "r1", "i1", "b1", "t1")


def module(limit: float, *, reach: int) -> types.ModuleType:
    """Make a module with a constant and a default."""
    made = types.ModuleType("made")
    made.LIMIT = limit  # type: ignore[attr-defined]
    exec(f"def work(x, *, reach={reach}): return x", made.__dict__)  # noqa: S102
    made.work.__module__ = "made"
    return made


def test_a_changed_constant_or_default_is_another_version() -> None:
    told = [
        versions.parameters(module(limit, reach=reach))
        for limit, reach in ((1.0, 2), (1.0, 3), (1.5, 2))
    ]
    assert len(set(told)) == 3
    assert versions.parameters(module(1.0, reach=2)) == told[0]


def test_a_stage_knows_all_modules_that_it_uses() -> None:
    names = [one.__name__ for one in versions.family(matte)]
    assert {"nostalgin_core.matte.matte", "nostalgin_core.matte.trimap"} <= set(names)
    assert not any(name.startswith("nostalgin_core.rectify") for name in names)
    assert names == sorted(names)


def test_a_changed_stage_makes_all_after_it_anew_and_none_before() -> None:
    changed = replace(MADE, rectify="r2")
    assert changed.segment_key("a") == MADE.segment_key("a")
    assert changed.matte_key("a") == MADE.matte_key("a")
    assert changed.rectify_key("a") != MADE.rectify_key("a")
    assert changed.inpaint_key("a", 0) != MADE.inpaint_key("a", 0)


def test_each_photo_and_each_facade_has_its_own_key() -> None:
    keys = [MADE.inpaint_key(photo, facade) for photo in "ab" for facade in (0, 1)]
    assert len(set(keys)) == 4


def test_another_network_is_another_version_of_its_stage_alone(tmp_path: Path) -> None:
    folders = [
        painted.write_models(tmp_path / str(number), segment=b"1", inpaint=data)
        for number, data in enumerate((b"2", b"3"))
    ]
    first, second = (Versions.present(Models(str(folder))) for folder in folders)
    assert first.inpaint != second.inpaint
    assert replace(first, inpaint="") == replace(second, inpaint="")


def test_a_network_that_is_not_what_the_lock_names_is_refused(tmp_path: Path) -> None:
    folder = painted.write_models(tmp_path, segment=b"1")
    (folder / "segment.onnx").write_bytes(b"2")
    with pytest.raises(Unlocked, match=r"segment\.onnx"):
        Models(str(folder)).read("segment")
    with pytest.raises(Unlocked, match="inpaint"):
        Models(str(folder)).read("inpaint")
