"""The painted archive's own list, in the columns of the city's real one."""

from nostalgin_core.scenes.lot import Lot
from nostalgin_core.scenes.street import Neighbourhood

FOOT_M = 0.3048
BLANK = (
    "Delete",
    "Borough",
    "QC",
    "1940 Block Number",
    "Alternative Block Number",
    "1940 Lot Number",
    "Alternative Lot Number",
    "1940 Building Number",
    "Alternative Building Number",
    "1940 Street Name",
    "Alternative Street Name",
    "Roll Number",
    "Landmark",
    "Complete Address",
    "Condition (Hole Punch, Deteriorated, Tape) ",
    "Notes",
    "ZIP Code",
    "LOT FRONTAGE",
    "LOT DEPTH",
    "YEAR BUILT",
    "YEAR ALTERED1",
    "YEAR ALTERED2",
    "Date",
    "Flagged",
    "File Name ",
)


def feet_inches(metres: float) -> str:
    """Write a length as the archive does: 59.03 is 59 feet 3 inches."""
    feet, inches = divmod(round(metres / FOOT_M * 12), 12)
    return f"{feet}.{inches:02d}"


def photo_name(lot: Lot, view: int = 0) -> str:
    """Name a photo as the archive does, without its suffix."""
    letter = "" if view == 0 else "abcdefgh"[view - 1]
    return f"nynyma_rec0040_1_{int(lot.block):05d}_{int(lot.lot):04d}{letter}"


def catalogue_rows(neighbourhood: Neighbourhood) -> list[dict[str, str]]:
    """List every photo of every lot, one row each, in the archive's order.

    A corner lot stands under its avenue; its other street is in the columns named
    Alternative.
    """
    return [
        row(lot, view)
        for block in neighbourhood.blocks
        for lot in block.lots
        for view in range(lot.photos)
    ]


def row(lot: Lot, view: int) -> dict[str, str]:
    """Fill in one row."""
    by_avenue = sorted(lot.fronts, key=lambda front: front.side % 2 == 0)
    main, *other = by_avenue
    filled: dict[str, str] = dict.fromkeys(map(str, BLANK), "")
    filled |= {
        "Borough": "Manhattan",
        "QC": "*",
        "1940 Block Number": lot.block,
        "1940 Lot Number": lot.lot,
        "1940 Building Number": main.address,
        "1940 Street Name": main.street,
        "Roll Number": "P-0001",
        "Complete Address": f"{main.address} {main.street}",
        "LOT FRONTAGE": feet_inches(main.width_m),
        "LOT DEPTH": feet_inches(main.depth_m or 0.0),
        "Date": "1939-1941",
        "File Name ": photo_name(lot, view),
    }
    if other:
        filled["Alternative Building Number"] = other[0].address
        filled["Alternative Street Name"] = other[0].street
    return filled
