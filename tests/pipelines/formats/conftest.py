"""A published city of two painted blocks, and all that is exported of it."""

from pathlib import Path

import pytest

from pipelines.formats import export
from tests.pipelines.formats import shown_city
from tests.pipelines.formats.shown_city import BASE


@pytest.fixture(scope="module")
def globe(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Publish two painted blocks on the globe."""
    folder = tmp_path_factory.mktemp("globe")
    one, two = (shown_city.block_model(n, (0.0, 90.0 * int(n))) for n in "12")
    return shown_city.published(folder, one, two, place=shown_city.MIDTOWN)


@pytest.fixture(scope="module")
def out(globe: Path) -> Path:
    folder = globe.parent / "out"
    export(globe, folder, ("cityjson", "obj", "geojson", "iiif"), base=BASE)
    return folder
