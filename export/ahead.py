"""Samples are drawn ahead by other processes, in the order of their steps.

A network on a GPU learns faster than one process can draw. What a step sees depends on
its number alone, so that a training with any number of workers sees the same.
"""

import multiprocessing
from collections.abc import Callable, Generator
from queue import Empty
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from multiprocessing.queues import Queue

T = TypeVar("T")
AHEAD = 4  # samples that may wait for each worker, to bound the memory
PATIENCE_S = 5.0  # between looks at whether a silent worker still lives


def ahead(
    draw: Callable[[int], T], first: int, last: int, *, workers: int = 0
) -> Generator[T, None, None]:
    """Give `draw(step)` for each step from `first` to before `last`, in order.

    Workers are forked, so that they share what `draw` reads; worker k draws every
    `workers`th step. What is drawn must be picklable: arrays, not tensors. Without
    workers, each is drawn when it is asked for.

    Raises:
        RuntimeError: if a worker died.
    """
    if not workers:
        yield from map(draw, range(first, last))
        return
    forked = multiprocessing.get_context("fork")
    queues = [forked.Queue(AHEAD) for _ in range(workers)]
    shares = [range(first + k, last, workers) for k in range(workers)]
    running = [
        forked.Process(target=_fill, args=(draw, share, queue), daemon=True)
        for share, queue in zip(shares, queues, strict=True)
    ]
    for worker in running:
        worker.start()
    try:
        for step in range(last - first):
            yield _next(queues[step % workers], running[step % workers])
    finally:
        for worker in running:
            worker.terminate()
            worker.join()


def _fill(draw: Callable[[int], T], steps: range, queue: "Queue[T]") -> None:
    """Draw a worker's steps."""
    for step in steps:
        queue.put(draw(step))


def _next(queue: "Queue[T]", worker: Any) -> T:  # noqa: ANN401 - forked contexts vary
    """Wait for a worker's next sample, as long as it lives."""
    while True:
        try:
            return queue.get(timeout=PATIENCE_S)
        except Empty:
            if not worker.is_alive():
                raise RuntimeError("a process that draws samples died") from None
