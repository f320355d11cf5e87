"""An archive's list becomes lots, and lots become fronts in order round their block.

In: rows of cells. Out: entries, then `Front`s with ring, side and rank.
Paper: section 3.5 takes this order as given. Open `catalogue` first, then `rings`.
"""

from nostalgin_core.catalogue.catalogue import (
    Catalogue,
    matched,
    named_in,
    plain,
    read,
    unknown,
)
from nostalgin_core.catalogue.doubt import Doubt
from nostalgin_core.catalogue.entry import Entry, from_file_name, inside, stem
from nostalgin_core.catalogue.lengths import decimal
from nostalgin_core.catalogue.naming import NAMELESS, Naming
from nostalgin_core.catalogue.rings import fronts

__all__ = [
    "NAMELESS",
    "Catalogue",
    "Doubt",
    "Entry",
    "Naming",
    "decimal",
    "from_file_name",
    "fronts",
    "inside",
    "matched",
    "named_in",
    "plain",
    "read",
    "stem",
    "unknown",
]
