"""What a person asks of a city afterwards: what came of it, and what was done to it.

In: a city folder's runs. Out: one page with charts and pictures, and a history.
Open `figures` first.
"""

from pipelines.report.figures import NoRun, figures
from pipelines.report.history import Past, history
from pipelines.report.page import page

__all__ = ["NoRun", "Past", "figures", "history", "page"]
