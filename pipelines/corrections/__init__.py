"""What people know better than a list or a network, merged over the manifest.

In: `corrections.csv` or `.jsonl` of a city folder, and the manifest's rows. Out: rows
and blocks as corrected, and what each correction changed. Open `corrections` first.
"""

from pipelines.corrections.applied import Applied, applied
from pipelines.corrections.corrections import of_file, read
from pipelines.corrections.fitting import fitting
from pipelines.corrections.found import Found, found, hashed, published
from pipelines.corrections.measured import measured

__all__ = [
    "Applied",
    "Found",
    "applied",
    "fitting",
    "found",
    "hashed",
    "measured",
    "of_file",
    "published",
    "read",
]
