"""What is told of a building in every format, in the same words and units."""

from typing import Any, Final

from nostalgin_core.formats import Shell, Shown

Json = dict[str, Any]

KEPT: Final = (
    "lot",
    "address",
    "street",
    "width_m",
    "width_assumed",
    "height_low_m",
    "height_high_m",
    "height_by_storeys_m",
    "height_by_width_m",
    "height_assumed",
    "assumed",
    "photographed_share",
)
SHARE: Final = 4  # digits


def attributes(shown: Shown, shell: Shell, building: Json) -> Json:
    """Tell a building's facts, heights, evidence by area of its walls, and rights."""
    shares = shown.shares(shell)
    return {
        "block": shown.block,
        **{name: building[name] for name in KEPT if name in building},
        "height_m": round(shell.height_m, 3),
        **{f"evidence_{word}": round(share, SHARE) for word, share in shares.items()},
        "photos": " ".join(one["key"] for one in building.get("photos", ())),
        "credit": str(shown.extras.get("credit", "")),
        "licence": str(shown.extras.get("licence", "")),
    }
