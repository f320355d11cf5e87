"""Dates as libraries exchange them: EDTF, which is ISO 8601-2:2019."""

import re
from functools import lru_cache
from typing import Final

LONGEST: Final = 80  # letters of a date
YEAR: Final = re.compile(r"(?<!\d)\d{4}(?!\d)")
NUMBERED: Final = re.compile(r"\d+[/.]\d+[/.]\d+")  # 1/2/1939: whose month is first?


@lru_cache(maxsize=4096)
def edtf(written: str) -> str | None:
    """Write a date as EDTF; None where what is written has no certain meaning.

    What is EDTF stays as it is. Words are read only where nothing is lost or made up:
    all years that are written are in what was read, in order, and no others.
    """
    bare = " ".join(written.split())
    if not bare or len(bare) > LONGEST:
        return None
    import edtf as library  # half a second: only lists with dates wait for it

    if library.parse_edtf(bare, fail_silently=True) is not None:
        return bare
    if NUMBERED.search(bare):
        return None
    read = library.text_to_edtf(bare)
    if not read or library.parse_edtf(read, fail_silently=True) is None:
        return None
    said, meant = YEAR.findall(bare), YEAR.findall(read)
    decade = not meant and "X" in read and read[:3] + "0" in said[:1]
    same = said == meant and meant == sorted(meant)
    return read if (same and said) or (decade and len(said) <= 1) else None
