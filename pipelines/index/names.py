"""What the name of a file, or of the folder that it lies in, tells of its place."""

import hashlib
import os
import re
from pathlib import Path
from typing import Final

from nostalgin_core.catalogue import from_file_name

LONGEST: Final = 48  # letters of a folder that names a block
# 993_8a, 993-8, block 993 lot 8: the two numbers at the end, with a view's letter
BLOCK_AND_LOT: Final = re.compile(r"(?:^|\D)(\d{1,5})\D{1,7}?(\d{1,4})[a-z]?$")


def row_name(folder: str) -> str:
    """Call a row of photos after its folder; a name that is no block's is replaced."""
    if len(folder) <= LONGEST and not set(folder) & set("/\\\0") and folder.strip():
        return folder
    return f"row {hashlib.sha256(os.fsencode(folder)).hexdigest()[:12]}"


def block_and_lot(name: str) -> tuple[str, str] | None:
    """Read block and lot from a file name, if it tells both."""
    exact = from_file_name(name)
    if exact is not None:
        return exact
    found = BLOCK_AND_LOT.search(Path(name).stem.strip().casefold())
    return (str(int(found[1])), str(int(found[2]))) if found else None
