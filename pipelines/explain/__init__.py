"""One photograph through every stage, as pictures and numbers.

In: a file's bytes. Out: PNGs, `panel.png` and `explain.json`, by explain.schema.json.
All views of one front of a city: `explain_front`.
Paper: the figure `complete`. Open `explain` first.
"""

from pipelines.explain.drawn import Redrawn, redrawn
from pipelines.explain.explain import Unreadable, explain
from pipelines.explain.front import Unshown, explain_front

__all__ = [
    "Redrawn",
    "Unreadable",
    "Unshown",
    "explain",
    "explain_front",
    "redrawn",
]
