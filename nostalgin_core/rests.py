"""All that a texel of a wall can rest on: one photograph, or several of one front.

The codes of `evidence` are those of one photograph, and the stages that see no more
than one know no others. What the photographs of neighbours add comes after them.
"""

from typing import Final

from nostalgin_core import evidence

ANOTHER: Final = 7  # hidden in the front's own photograph, seen in a neighbour's

NAMES: Final = {**evidence.NAMES, ANOTHER: "photographed in another picture"}
TINTS: Final = {**evidence.TINTS, ANOTHER: (110, 225, 150)}  # as those of `evidence`
