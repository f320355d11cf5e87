"""Cases of which something else comes out than must, each with its reason.

A case that is listed here and passes fails its test: it is no longer open.
"""

from typing import Final

OF_REASON: Final[dict[str, tuple[str, ...]]] = {}
OPEN: Final = {case: why for why, cases in OF_REASON.items() for case in cases}
