"""A run becomes a static folder that any web server turns into a walkable city.

In: a run's tables and models. Out: `CITY/site`, and the pointer to the run.
Open `publish` first.
"""

from pipelines.site.folder import Folder, Foreign, inside, recorded
from pipelines.site.naming import altered, safe
from pipelines.site.publish import claim, damaged, publish
from pipelines.site.record import credited, record
from pipelines.site.site import ViewerMissingError, thumbnail

__all__ = [
    "Folder",
    "Foreign",
    "ViewerMissingError",
    "altered",
    "claim",
    "credited",
    "damaged",
    "inside",
    "publish",
    "record",
    "recorded",
    "safe",
    "thumbnail",
]
