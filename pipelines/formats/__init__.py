"""A published city written for other programs, block by block.

In: `CITY/site`, and for its provenance the run's tables. Out: a folder a format.
Open `export` first.
"""

from pipelines.formats.export import export
from pipelines.formats.published import Unexportable

__all__ = ["Unexportable", "export"]
