"""How the command line speaks: lines for people, or JSON for machines."""

import json
from dataclasses import dataclass
from typing import Any

from rich.console import Console


@dataclass
class Voice:
    """Tells people in lines, or machines in JSON, a line an event."""

    console: Console
    machine: bool = False

    def say(self, event: str, text: str, **facts: Any) -> None:
        """Tell one event."""
        if self.machine:
            print(json.dumps({"event": event, **facts}), flush=True)  # noqa: T201
        else:
            self.console.print(text, markup=False, highlight=False)
