"""Where the real photographs and labels lie, which are never part of the project."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
DATA = Path(os.environ.get("NOSTALGIN_DATA", ROOT.parent / "shared" / "data"))

needs_data = pytest.mark.skipif(
    not (DATA / "taxphotos").is_dir(),
    reason=f"no real photographs at {DATA}; set NOSTALGIN_DATA to their folder",
)
