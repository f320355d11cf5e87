"""One photograph through every stage, as pictures and numbers.

In: a file's bytes. Out: PNGs, `panel.png` and `explain.json`, by explain.schema.json.
Paper: the figure `complete`. Open `explain` first.
"""

from pipelines.explain.explain import Unreadable, explain

__all__ = ["Unreadable", "explain"]
