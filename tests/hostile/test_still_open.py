"""The list of open cases names cases, and names each once."""

from tests.hostile import (
    artifacts,
    catalogues,
    folders,
    images,
    manifests,
    names,
    networks,
    options,
    outputs,
)
from tests.hostile.case import called
from tests.hostile.still_open import OF_REASON, OPEN
from tests.hostile.test_artifacts import HEALED

ALL = {
    "image": images.cases(),
    "name": names.cases(),
    "folder": folders.cases(),
    "photo": folders.unreadable(),
    "catalogue": catalogues.cases(),
    "catalogue row": catalogues.rows(),
    "formula": catalogues.captions(),
    "manifest": manifests.cases(),
    "manifest row": manifests.rows(),
    "network": networks.cases(),
    "artifact": artifacts.cases(),
    "option": options.cases(),
    "output": outputs.cases(),
}
NAMES = [f"{kind}: {called(one)}" for kind, cases in ALL.items() for one in cases]
OTHERS = {f"artifact: {HEALED}", "fuzz: artifact bytes"}


def test_there_are_many_and_no_two_of_one_name() -> None:
    assert len(NAMES) > 500
    assert len(set(NAMES)) == len(NAMES)


def test_what_is_open_is_a_case() -> None:
    assert set(OPEN) <= {*NAMES, *OTHERS}
    assert sum(map(len, OF_REASON.values())) == len(OPEN)
