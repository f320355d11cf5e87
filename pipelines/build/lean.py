"""Loads Beam without what it would load for others: clients of stores and of Google.

Each of a run's processes would load them, and none has a use for them; Beam itself goes
on where they are not installed. Afterwards they can be had again. (City folders in
buckets are reached by Arrow.)
"""

import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, Final

UNUSED: Final = ("boto3", "bson", "pymongo", "apache_beam.io.gcp.bigquery")


@contextmanager
def without(*names: str) -> Iterator[None]:
    """Let modules that are not loaded yet be taken for not installed."""
    modules: dict[str, Any] = sys.modules
    barred = [name for name in names if name not in modules]
    before = logging.root.manager.disable
    modules.update(dict.fromkeys(barred))  # None: as `import` takes what is not there
    logging.disable(logging.WARNING)  # Beam tells what lacks
    try:
        yield
    finally:
        logging.disable(before)
        for name in barred:
            del modules[name]


with without(*UNUSED):
    import apache_beam as apache_beam  # noqa: PLC0414 - it is loaded, not used
