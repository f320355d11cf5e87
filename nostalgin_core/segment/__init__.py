"""A network finds fronts and what hides them; holes and flares of the film are added.

In: a `Photo` and a network. Out: its `Instance`s, one mask each, or a `Rejection`.
Paper: section 3.2, Mask R-CNN. Open `segment` first.
"""

from nostalgin_core.segment.answer import CATEGORIES, Network, Nonsense, probe
from nostalgin_core.segment.segment import segment

__all__ = ["CATEGORIES", "Network", "Nonsense", "probe", "segment"]
