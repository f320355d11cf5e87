"""One city for all tests of a module, as it was written before each."""

from pathlib import Path

import pytest

from tests.pipelines.reprocess import changing


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return changing.written(tmp_path_factory.mktemp("painted"))


@pytest.fixture
def city(written: Path) -> Path:
    return changing.restored(written)
