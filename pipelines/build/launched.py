"""A pipeline is run to its end, by whichever runner is asked for.

What ends a run is told in words: a worker that was killed, a folder that takes no more.
"""

import contextlib
import copy
import errno
import re
import shutil
from collections.abc import Callable, Iterator
from typing import Final

import apache_beam as beam
from apache_beam.options.pipeline_options import PipelineOptions, StandardOptions
from apache_beam.runners.runner import PipelineResult

from pipelines import stopping
from pipelines.build import cluster, embedded
from pipelines.build.report import Lost
from pipelines.store import Store, Unstored

# Of a disk that is full or may not be written to, or a file in a folder's place.
FULL: Final = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
BARRED: Final = (errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOTDIR, errno.EISDIR)
# As a worker's traceback has it; a run's tables are written without `keep`.
UNWRITTEN: Final = (
    rf"{Unstored.__name__}: (.*)",
    rf"\w+Error: (\[Errno (?:{'|'.join(map(str, (*FULL, *BARRED)))})\].*)",
)


def launched(
    options: PipelineOptions, wire: Callable[[beam.Pipeline], None], store: Store
) -> PipelineResult:
    """Run what `wire` adds to a pipeline to its end.

    Raises:
        Lost: if what was made could not be kept.
        Unrun: if a cluster gave up.
        Stopped: if somebody asked to end.
    """
    stopping.check()
    result = ran(options, wire, store)
    stopping.check()  # what it was asked to make may lack
    return result


def ran(
    options: PipelineOptions, wire: Callable[[beam.Pipeline], None], store: Store
) -> PipelineResult:
    """Run what `wire` adds to a pipeline, and raise as `launched` does."""
    runner = options.view_as(StandardOptions).runner
    if runner != embedded.EMBEDDED:
        with cluster.told(runner):
            pipeline = beam.Pipeline(options=options)
            with swept(pipeline):
                wire(pipeline)
                result = pipeline.run()
            try:
                with stopping.at_once():
                    result.wait_until_finish()
            except stopping.Stopped as why:
                if not cluster.cancelled(result):
                    words = f"{why}; {cluster.UNSURE}"
                    raise stopping.Stopped(words, why.code) from why
                raise
        return result
    given = copy.deepcopy(options)  # which the embedded runner changes for itself
    pipeline = beam.Pipeline(embedded.runner(given), options=given)
    try:
        with (
            swept(pipeline),
            embedded.on_loopback(),
            embedded.ending_with_a_worker(),
        ):
            wire(pipeline)
            result = pipeline.run()
            result.wait_until_finish()
    except embedded.WorkerLost as problem:
        words = f"{problem}: build again, with fewer workers if memory is short"
        raise Lost(f"{words}; what is kept already is not made twice") from problem
    except Unstored as problem:
        raise Lost(unstored(store, str(problem))) from problem
    except RuntimeError as problem:  # a worker's exception reaches us as its traceback
        why = unwritten(str(problem))
        if not why:
            raise
        raise Lost(unstored(store, why)) from problem
    return result


@contextlib.contextmanager
def swept(pipeline: beam.Pipeline) -> Iterator[None]:
    """Remove a pipeline's folder of temporary files also where its run raises."""
    try:
        yield
    finally:
        shutil.rmtree(pipeline.local_tempdir, ignore_errors=True)


def unwritten(traceback: str) -> str:
    """Tell of a worker's traceback what could not be written; empty: it tells none."""
    lines = (re.search(pattern, traceback) for pattern in UNWRITTEN)
    return next((one[1] for one in lines if one is not None), "")


def unstored(store: Store, why: str) -> str:
    """Say that a run ended because what it made could not be kept."""
    why = why.partition(" [while running")[0]  # which Beam adds
    return (
        f"{store.root} takes no more artifacts: {why}; make room or mend the folder, "
        "and build again: what is kept already is not made twice"
    )
