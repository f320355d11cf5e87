"""Fronts and facades for tests: of one block, plain but for what a test is about."""

from typing import Any

from nostalgin_core.records import Front, Seen


def front(lot: str, side: int = 0, rank: int = 0, **more: Any) -> Front:
    """Make a front of block 9, ten metres wide; any field may be told otherwise."""
    block = more.pop("block", "9")
    plain: dict[str, Any] = {
        "ring": 0,
        "street": f"street {side}",
        "address": "1",
        "width_m": 10.0,
        "depth_m": None,
        "width_assumed": False,
    }
    return Front(
        front_id=f"{block}-{lot}-{side}",
        block=block,
        lot=lot,
        side=side,
        rank=rank,
        **plain | more,
    )


def seen(photo: str = "p", facade: int = 0, **more: Any) -> Seen:
    """Make a target that is seen clearly; any field may be told otherwise."""
    plain: dict[str, Any] = {
        "target": True,
        "target_score": 0.9,
        "score": 0.95,
        "aspect": 0.8,
        "aspect_sd": 0.05,
        "left_px": 120.0,
        "area_px": 60_000.0,
        "photographed": 0.9,
    }
    return Seen(photo=photo, facade=facade, **plain | more)
