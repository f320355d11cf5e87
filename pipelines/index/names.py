"""What the name of a folder tells of the place of the photographs in it."""

import hashlib
import os
from typing import Final

LONGEST: Final = 48  # letters of a folder that names a block


def row_name(folder: str) -> str:
    """Call a row of photos after its folder; a name that is no block's is replaced."""
    if len(folder) <= LONGEST and not set(folder) & set("/\\\0") and folder.strip():
        return folder
    return f"row {hashlib.sha256(os.fsencode(folder)).hexdigest()[:12]}"
