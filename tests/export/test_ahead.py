import os

import numpy as np
import pytest

from export import ahead


def drawn(step: int) -> tuple[int, float]:
    return step, float(np.random.default_rng([7, step]).random())


@pytest.mark.parametrize("workers", [1, 3])
def test_any_number_of_workers_draws_the_same_in_order(workers: int) -> None:
    alone = list(ahead.ahead(drawn, 5, 16))
    assert [step for step, _ in alone] == list(range(5, 16))
    assert list(ahead.ahead(drawn, 5, 16, workers=workers)) == alone


def test_workers_end_when_no_more_is_asked_for() -> None:
    samples = ahead.ahead(lambda step: (step, os.getpid()), 0, 10**6, workers=2)
    (first, one), (second, other) = next(samples), next(samples)
    assert (first, second) == (0, 1)
    assert len({one, other, os.getpid()}) == 3
    samples.close()
    for process in (one, other):
        with pytest.raises(ProcessLookupError):
            os.kill(process, 0)


def test_a_worker_that_dies_is_told_of(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ahead, "PATIENCE_S", 0.1)
    samples = ahead.ahead(lambda _: os._exit(1), 0, 4, workers=1)
    with pytest.raises(RuntimeError, match="died"):
        next(samples)
