"""How wide the streets are that cut a block in two, where somebody has told it."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from nostalgin_core.block import cutting_streets
from pipelines.index.plan import BlockTask


@dataclass(frozen=True)
class Streets:
    """Widths by the names of streets, and by block where its outline has two parts."""

    widths_m: Mapping[str, float] = field(default_factory=dict)  # names are plain
    gaps_m: Mapping[str, float] = field(default_factory=dict)

    def told(self, task: BlockTask) -> BlockTask:
        """Tell a block of two rings how wide the street between them is.

        What a table of streets says goes before what lies between two outlines.
        """
        numbers = sorted({front.ring for front in task.fronts})
        known = bool(self.widths_m) or task.block in self.gaps_m
        if len(numbers) != 2 or not known:
            return task
        rings = [[f for f in task.fronts if f.ring == number] for number in numbers]
        names = sorted(cutting_streets(rings))
        gap = self.gaps_m.get(task.block)
        wide = {name: self.widths_m.get(name, gap) for name in names}
        known_m = tuple((name, m) for name, m in wide.items() if m is not None)
        return replace(task, widths_m=known_m)
