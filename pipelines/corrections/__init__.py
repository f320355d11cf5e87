"""What people know better than a list or a network, merged over the manifest.

In: `corrections.csv` or `.jsonl` of a city folder, and the manifest's rows. Out: rows
and blocks as corrected, and what each correction changed. Open `corrections` first.
"""

from pipelines.corrections.applied import applied
from pipelines.corrections.corrections import read

__all__ = ["applied", "read"]
