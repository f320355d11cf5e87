"""How many storeys an elevation shows, by the rows in which its windows repeat.

In: an elevation and where a camera saw it. Out: a score for every count of storeys.
"""

from nostalgin_core.storeys.storeys import COUNTS, EXTRA, flattened, scores

__all__ = ["COUNTS", "EXTRA", "flattened", "scores"]
