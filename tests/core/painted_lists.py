"""Two painted lists of one block each, irregular as archives' lists are."""

from collections.abc import Sequence

from nostalgin_core import catalogue
from nostalgin_core.catalogue import Entry


def entries(
    block: str, sides: Sequence[tuple[str, Sequence[tuple[int, str]]]]
) -> list[Entry]:
    """List lots with their numbers, street by street, and a photo each."""
    rows = [
        {
            "block": block,
            "lot": str(lot),
            "street": street,
            "address": address,
            "photo": f"rec0040_1_{int(block):05d}_{lot:04d}",
        }
        for street, own in sides
        for lot, address in own
    ]
    return list(catalogue.read(rows).entries)


# A whole block with irregular numbers, ranges, unlisted lots and two later splits.
WHOLE = entries(
    "12",
    [
        ("Broadway", [(1, "700-706")]),
        ("West 20 Street", [(6, "251"), (8, "245-249"), (11, "239"), (12, "233-237")]),
        (
            "West 20 Street",
            [(15, "231"), (16, "221-225"), (19, "217"), (20, "211-215")],
        ),
        ("West 20 Street", [(23, "207"), (124, "201")]),
        ("7 Avenue", [(24, "210"), (25, "212-214"), (27, "216"), (28, "220")]),
        ("West 21 Street", [(30, "202"), (31, "206-208"), (33, "210"), (34, "212")]),
        (
            "West 21 Street",
            [(135, "216"), (36, "218-224"), (40, "228"), (42, "232-240")],
        ),
        ("West 21 Street", [(46, "246"), (47, "250-252")]),
        ("Broadway", [(50, "722"), (52, "712-716")]),
    ],
)
# A block that a slanting street cuts, as Broadway does 993.
SLANTING = entries(
    "13",
    [
        ("8 Avenue", [(1, "401-405"), (3, "407")]),
        ("West 22 Street", [(105, "273"), (5, "269-271"), (6, "265")]),
        ("Bowery", [(8, "1301-1303"), (9, "1305"), (11, "1307-1309")]),
        ("Bowery", [(13, "1302-1304")]),
        ("West 22 Street", [(15, "247"), (17, "239-243"), (19, "233"), (20, "227")]),
        ("6 Avenue", [(23, "801"), (24, "805-807"), (26, "813")]),
        ("West 23 Street", [(30, "228"), (31, "232-236"), (35, "240"), (37, "250")]),
        ("Bowery", [(40, "1322-1326"), (42, "1312-1316")]),
        ("Bowery", [(50, "1313"), (52, "1317-1321")]),
    ],
)
