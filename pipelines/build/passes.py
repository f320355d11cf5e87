"""What this machine does itself goes in passes, so that its memory stays as it is.

    rows --blocks that share photographs--> passes --a pipeline each--> tables of each
    tables of all passes --part by part, sorted--> tables of the run

Beam's embedded runner keeps all that goes between its stages in memory, until its
pipeline ends. A pass is a pipeline over a bounded number of rows, with workers of its
own. No photograph and no block is of two passes: so what all of them tell, row by row,
is what one pipeline over all rows would. Other runners keep shuffles on disk, and have
one pipeline.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Final

import apache_beam as beam
import numpy as np
import pyarrow as pa
from apache_beam.options.pipeline_options import PipelineOptions, StandardOptions
from apache_beam.runners.runner import PipelineResult
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from pipelines.build import embedded
from pipelines.build.launched import launched
from pipelines.build.options import processes_here
from pipelines.index import asked
from pipelines.index.asked import ASKED, Asked, short
from pipelines.index.roots import rooted
from pipelines.store import Store, runs

# Of a pass, for each process: its workers start in the time of two photographs, and
# the last of them waits for the others at its end.
ROWS: Final = 512
PLACED: Final = ("root", "photo", "block")

# Wires the work that is asked for, and its tables in so many parts.
Wire = Callable[[Asked, int, beam.Pipeline], None]


def worked(
    options: PipelineOptions, wire: Wire, store: Store, todo: Asked
) -> list[PipelineResult]:
    """Do what is asked for to its end, and give what each of its pipelines tells.

    Raises:
        Lost, Unrun, Stopped: as `launched`.
    """
    parts = runs.parts_of(todo.rows)
    drop(store, todo.run)  # of a run that was killed
    here = options.view_as(StandardOptions).runner == embedded.EMBEDDED
    most = ROWS * processes_here(options)
    if not here or todo.rows <= most:
        return [launched(options, wired(wire, todo, parts), store)]
    done, names = [], []
    for one in passes(store, todo, most):
        done.append(launched(options, wired(wire, one, parts), store))
        names.append(one.run)
    gather(store, todo.run, names, parts)
    drop(store, todo.run)
    return done


def wired(wire: Wire, todo: Asked, parts: int) -> Callable[[beam.Pipeline], None]:
    """Wire what one pipeline is asked for."""
    return lambda pipeline: wire(todo, parts, pipeline)


def passes(store: Store, todo: Asked, most: int) -> Iterator[Asked]:
    """Write what each pass is asked for, of `most` rows unless fewer belong together.

    Each is written when its turn comes. Rows that can't be used are of the first.
    """
    which, ends = passes_of(store, todo, most)
    for number in range(int(which.max(initial=0)) + 1):
        mine = which == number
        spans = list(enumerate(pairwise(ends)))
        there = [(n, mine[a:b]) for n, (a, b) in spans if mine[a:b].any()]
        run = f"{todo.run}/{runs.PASSES}/{number + 1:04}"
        sizes = asked.written(store, run, taken(store, todo.run, there))
        yield Asked(run, 0, 0, *sizes, todo.title)


def taken(
    store: Store, run: str, there: list[tuple[int, np.ndarray]]
) -> Iterator[pa.Table]:
    """Read some rows of some groups of what a run is asked for."""
    path = runs.table_path(run, ASKED)
    for number, mine in there:
        for table in store.read_groups(path, (number, number + 1)):
            yield table.filter(pa.array(mine))


def passes_of(store: Store, todo: Asked, most: int) -> tuple[np.ndarray, list[int]]:
    """Tell of each row in which pass it is, and where groups of rows end."""
    photos, blocks, ends = [np.zeros(0, np.uint64)], [np.zeros(0, np.uint64)], [0]
    for table in store.read_groups(runs.table_path(todo.run, ASKED)):
        own = hashes(table, store.root)
        photos.append(own[0])
        blocks.append(own[1])
        ends.append(ends[-1] + table.num_rows)
    names, shown = np.concatenate(photos), np.concatenate(blocks)
    usable = shown != 0
    nodes, labels = together(names[usable], shown[usable])
    of_row = labels[np.searchsorted(nodes, shown[usable])]
    which = np.zeros(len(shown), np.int64)
    which[usable] = dealt(of_row, most)
    return which, ends


def hashes(table: pa.Table, city: str) -> tuple[np.ndarray, np.ndarray]:
    """Hash the photograph and the block of each row; 0: it has none, or is no use."""
    cells = (table.column(name).to_pylist() for name in PLACED)
    refused = table.column("reason").is_valid().to_pylist()
    found = [
        (0, 0) if bad else (short(rooted(root, city), one) if one else 0, short(block))
        for root, one, block, bad in zip(*cells, refused, strict=True)
    ]
    each = np.array(found, np.uint64).reshape(-1, 2)
    return each[:, 0], each[:, 1]


def together(photos: np.ndarray, blocks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Group blocks that share photographs: all of both, sorted, and the group of each.

    Both are told of each row as eight bytes; a photograph may be 0: there is none.
    """
    nodes = np.union1d(photos[photos != 0], blocks)
    shown = photos != 0
    a = np.searchsorted(nodes, photos[shown])
    b = np.searchsorted(nodes, blocks[shown])
    edges = coo_array((np.ones(len(a), bool), (a, b)), shape=(len(nodes),) * 2)
    return nodes, connected_components(edges, directed=False)[1]


def dealt(groups: np.ndarray, most: int) -> np.ndarray:
    """Deal rows to passes by their groups, in the order of the groups' first rows."""
    labels, first, sizes = np.unique(groups, return_index=True, return_counts=True)
    order = np.argsort(first)
    number, filled = 0, 0
    of_group = np.zeros(len(labels), np.int64)
    for at, size in zip(order.tolist(), sizes[order].tolist(), strict=True):
        if filled and filled + size > most:
            number, filled = number + 1, 0
        of_group[at], filled = number, filled + size
    return of_group[np.searchsorted(labels, groups)]


def gather(store: Store, run: str, passed: list[str], parts: int) -> None:
    """Write a run's tables of those of its passes, a part at a time."""
    for name in runs.OF_WORK:
        for part in range(parts):
            which = (part, parts)
            paths = [runs.table_path(one, name, which) for one in passed]
            table = pa.concat_tables(store.read_table(path) for path in paths)
            runs.write_sorted(store, run, name, table, which)


def drop(store: Store, run: str) -> None:
    """Drop what passes have written."""
    store.drop_tree(f"runs/{run}/{runs.PASSES}")
