"""What is stale in a city is found, told, and redone alone.

In: a city folder with a published run, and its manifest as it is now. Out: a plan, or
the next published run; or an earlier one. Open `stale` first, then `reprocess`.
"""

from pipelines.reprocess.now import now
from pipelines.reprocess.plan import Plan, planned
from pipelines.reprocess.reprocess import Reprocessed, reprocess
from pipelines.reprocess.rollback import Unkept, rollback

__all__ = [
    "Plan",
    "Reprocessed",
    "Unkept",
    "now",
    "planned",
    "reprocess",
    "rollback",
]
