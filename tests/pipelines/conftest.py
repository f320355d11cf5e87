"""A painted city, built once for each module that has none of its own, and copies."""

import shutil
from pathlib import Path

import pytest

from tests.pipelines import painted
from tests.pipelines.cities import built, copied


@pytest.fixture(scope="module")
def city(tmp_path_factory: pytest.TempPathFactory) -> Path:
    city = painted.write_city(tmp_path_factory.mktemp("painted"))
    built(city)
    return city


@pytest.fixture
def other(city: Path, tmp_path: Path) -> Path:
    fresh = copied(city, tmp_path)
    return Path(shutil.copytree(city, fresh, dirs_exist_ok=True))
