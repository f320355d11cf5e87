"""What must be set before anything is loaded, and a browser for all who need one."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.chromium import CHROMIUM, SOFTWARE_GL

os.environ["ORT_DISABLE_TELEMETRY"] = "1"  # as `nostalgin_core.session` does


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Start a browser; no other module's processes are to be forked beside it."""
    playwright = pytest.importorskip("playwright.sync_api", reason="no Playwright")
    with playwright.sync_playwright() as driver:
        known = (
            CHROMIUM if CHROMIUM.is_file() else Path(driver.chromium.executable_path)
        )
        if not known.is_file():
            pytest.skip(f"no Chromium at {known}; set NOSTALGIN_CHROMIUM to one")
        running = driver.chromium.launch(executable_path=str(known), args=SOFTWARE_GL)
        yield running
        running.close()
