"""Builds the viewer into the wheel, where nobody has built it before."""

import shutil
import subprocess
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class ViewerHook(BuildHookInterface):
    """A wheel without its viewer could build cities that nobody can see."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Run npm if the viewer is missing; an editable install may come without it."""
        del build_data
        root = Path(self.root)
        if (
            version == "editable"
            or (root / "pipelines/site/viewer_dist/index.html").exists()
        ):
            return
        npm = shutil.which("npm")
        if npm is None:
            message = "no npm to build the viewer with: run `make viewer` first"
            raise RuntimeError(message)
        for command in ("ci", "run build"):
            subprocess.run([npm, *command.split()], cwd=root / "viewer", check=True)
