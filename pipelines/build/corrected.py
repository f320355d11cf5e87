"""A build's work as people have corrected it, and what that is a hash of."""

import hashlib
from dataclasses import replace

from pipelines import corrections
from pipelines.index.manifest import Manifest
from pipelines.index.plan import BlockTask, Plan
from pipelines.store import Store


def mended(store: Store, found: Manifest) -> tuple[Manifest, corrections.Applied]:
    """Merge a city's corrections over its manifest; the file itself stays as it is.

    The manifest's hash takes in theirs, so that another run is another run.
    """
    given = corrections.read(store)
    made = corrections.applied(found.rows, given)
    both = f"{found.sha256} {given.sha256}".encode()
    sha256 = hashlib.sha256(both).hexdigest() if given.sha256 else found.sha256
    rejections = (*found.rejections, *made.rejections)
    return replace(found, rows=made.rows, rejections=rejections, sha256=sha256), made


def directed(todo: Plan, made: corrections.Applied) -> Plan:
    """Tell blocks what no row tells: heights that are known, and facades meant."""

    def told(task: BlockTask) -> BlockTask:
        lots = {f"{front.block}-{front.lot}" for front in task.fronts}
        heights_m = {one: h for one, h in made.heights_m.items() if one in lots}
        names = dict.fromkeys(name for name, _ in task.photos)
        targets_px = {
            name: made.targets_px[name[1]]
            for name in names
            if name[1] in made.targets_px
        }
        return replace(
            task,
            heights_m=tuple(sorted(heights_m.items())),
            targets_px=tuple(sorted(targets_px.items())),
        )

    return replace(todo, blocks=tuple(map(told, todo.blocks)))
