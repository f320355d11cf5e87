"""What lies about in single files is packed, by the workers if it is much."""

import contextlib
import os
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import apache_beam as beam
from apache_beam.options.pipeline_options import PipelineOptions

from pipelines import stopping
from pipelines.build.cluster import Unrun
from pipelines.build.embedded import in_process
from pipelines.build.launched import launched
from pipelines.build.report import Lost
from pipelines.store import Piece, Store, pack, pack_piece, pieces
from pipelines.store.versions import Versions

FEW: Final = 16  # pieces, which take less than the start of workers does
THREADS: Final = 2  # of which each holds a pack


def tidied(options: PipelineOptions, store: Store, versions: Versions) -> None:
    """Pack the artifacts that lie about: what is done, the next run knows by a listing.

    A disk that is full, a runner that fails, and whoever asks to end, keep them as they
    are: the run has come to its end before.
    """
    kept = (OSError, Lost, Unrun, stopping.Stopped)
    with contextlib.suppress(*kept):
        folders = list(map(versions.folder, vars(versions)))
        todo = [one for folder in folders for one in pieces(store, folder)]
        if len(todo) > FEW and not in_process(options):
            era = f"{os.getpid()}.{time.time_ns()}"  # each process lists a folder once
            packing = Packing(replace(store, era=era))
            launched(options, partial(wired, packing, todo), store)
            return
        with ThreadPoolExecutor(THREADS) as pool:  # they wait for the disk by turns
            list(pool.map(partial(packed, store), folders))


def packed(store: Store, folder: str) -> None:
    """Pack the artifacts of one stage, unless somebody asks to end."""
    stopping.check()
    pack(store, folder)


@dataclass(frozen=True)
class Packing:
    """Packs pieces until somebody asks to end."""

    store: Store

    def __call__(self, piece: Piece) -> None:
        """Pack one."""
        if not stopping.asked():
            pack_piece(self.store, piece)


def wired(packing: Packing, todo: Sequence[Piece], pipeline: beam.Pipeline) -> None:
    """Wire the packing of pieces, of which a stage has 256 at most."""
    _ = (
        pipeline
        | "Pieces" >> beam.Create(todo)
        | "Spread" >> beam.Reshuffle()
        | "Pack" >> beam.Map(packing)
    )
