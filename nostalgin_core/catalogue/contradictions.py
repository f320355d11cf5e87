"""Rows that say twice the same, or otherwise than the name of their own photograph."""

from collections.abc import Iterator, Sequence

from nostalgin_core.catalogue.entry import Entry, from_file_name


def contradictions(rows: Sequence[Entry]) -> Iterator[str]:
    """Name the rows of one block that were written twice, or for another lot's photo.

    A photo's name tells its lot only in an archive that names its files so.
    """
    seen: dict[tuple[str, ...], int] = {}
    for row in rows:
        says = (row.photo, row.lot, row.street, row.address)
        first = seen.setdefault(says, row.row)
        if first != row.row:
            yield (
                f"block {row.block}, lot {row.lot}: rows {first} and row {row.row} say "
                "the same; delete one of them"
            )
        named = from_file_name(row.photo)
        if named is not None and named != (row.block, row.lot):
            yield (
                f"block {row.block}, lot {row.lot}: row {row.row} names {row.photo}, by "
                f"its name a photo of block {named[0]}, lot {named[1]}; mend the lot or "
                "the photo"
            )
