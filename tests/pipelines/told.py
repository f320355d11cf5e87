"""What a site tells of its buildings, from all its parts together."""

import json
from pathlib import Path
from typing import Any


def told_blocks(site: Path) -> list[dict[str, Any]]:
    """Read all blocks of a site: their headers, with their buildings in place."""
    headers = json.loads((site / "site.json").read_text())["blocks"]
    return [header | record(site, header) for header in headers]


def told_buildings(site: Path) -> list[dict[str, Any]]:
    """Read all buildings of a site."""
    return [one for block in told_blocks(site) for one in block["buildings"]]


def record(site: Path, header: dict[str, Any]) -> dict[str, Any]:
    """Read what is known of one block's buildings."""
    return json.loads((site / header["record"]).read_text())
