"""Other people's programs that read what we write, in a Python that has them.

Some hold back libraries that the project has newer, so they may live elsewhere:
NOSTALGIN_READERS names a Python with the extra `readers`. NOSTALGIN_CJVAL names the
official validator of CityJSON, `cargo install cjval --features build-binary`.
"""

import json
import os
import shutil
import subprocess
import sys
from typing import Any

import pytest

PYTHON = os.environ.get("NOSTALGIN_READERS", sys.executable)
CJVAL = os.environ.get("NOSTALGIN_CJVAL") or shutil.which("cjval")


def told(module: str, script: str, *words: str) -> Any:
    """Run a script that prints JSON; skip where its module is not there."""
    asked = [PYTHON, "-W", "ignore", "-c", f"import {module}"]
    if subprocess.run(asked, capture_output=True, check=False).returncode:
        pytest.skip(f"no {module} in {PYTHON}: set NOSTALGIN_READERS")
    command = [PYTHON, "-W", "ignore", "-c", script, *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])
