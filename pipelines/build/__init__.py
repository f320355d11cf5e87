"""The Beam pipeline: every photo through its stages, every block to its model.

In: a city folder with a manifest. Out: artifacts, a run's tables, a `Report`.
A stage of the core is a transform here; whom to tell, it is given. Open `city` first.
"""

from pipelines.build.build import build
from pipelines.build.cluster import Unrun
from pipelines.build.external import serve
from pipelines.build.options import options
from pipelines.build.report import Lost, Report

__all__ = ["Lost", "Report", "Unrun", "build", "options", "serve"]
