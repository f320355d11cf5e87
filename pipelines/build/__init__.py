"""The Beam pipeline: every photo through its stages, every block to its model.

In: a city folder with a manifest. Out: artifacts, a run's tables, a `Report`.
A stage of the core is a transform here; whom to tell, it is given. Open `city` first.
"""

import pipelines.build.lean  # noqa: F401 - before all that loads Beam
from pipelines.build.attempt import CRASHED
from pipelines.build.boards import boards, boards_read
from pipelines.build.build import (
    Tell,
    Watch,
    build,
    carried_out,
    made_alone,
    readied,
    silent,
    unwatched,
)
from pipelines.build.cluster import Unrun
from pipelines.build.corrected import Corrected, corrected
from pipelines.build.external import serve
from pipelines.build.isolation import ASIDE
from pipelines.build.options import CityOptions, options, processes_here
from pipelines.build.passes import together
from pipelines.build.prepared import (
    DIRECTED,
    Prepared,
    anchored,
    bench_of,
    direct,
    mark_of,
    schemes_of,
    told_of_run,
    written_anew,
    written_words,
)
from pipelines.build.report import Lost, Report
from pipelines.build.streets import Streets
from pipelines.build.took import Took

__all__ = [
    "ASIDE",
    "CRASHED",
    "DIRECTED",
    "CityOptions",
    "Corrected",
    "Lost",
    "Prepared",
    "Report",
    "Streets",
    "Tell",
    "Took",
    "Unrun",
    "Watch",
    "anchored",
    "bench_of",
    "boards",
    "boards_read",
    "build",
    "carried_out",
    "corrected",
    "direct",
    "made_alone",
    "mark_of",
    "options",
    "processes_here",
    "readied",
    "schemes_of",
    "serve",
    "silent",
    "together",
    "told_of_run",
    "unwatched",
    "written_anew",
    "written_words",
]
