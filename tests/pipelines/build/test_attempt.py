import apache_beam as beam
import pytest
from apache_beam.testing.util import assert_that, equal_to

from nostalgin_core.records import Rejection
from pipelines.build.attempt import Attempt, subject
from pipelines.build.took import edge


def halve(n: int) -> int | Rejection:
    return n // 2 if n % 2 == 0 else Rejection(str(n), "halve", "odd")


def up_to(n: int) -> list[int | Rejection]:
    return [halve(one) for one in range(n)]


def inverse(n: int) -> float:
    return 1 / n


def test_nothing_is_lost() -> None:
    with beam.Pipeline(runner="FnApiRunner") as pipeline:
        halved = pipeline | beam.Create([1, 2, 0]) | Attempt(halve)
        assert_that(halved.made, equal_to([1, 0]), label="made")
        odd = Rejection("1", "halve", "odd")
        assert_that(halved.rejected, equal_to([odd]), label="rejected")


def test_a_list_gives_all_that_is_in_it() -> None:
    with beam.Pipeline(runner="FnApiRunner") as pipeline:
        halved = pipeline | beam.Create([4]) | Attempt(up_to)
        assert_that(halved.made, equal_to([0, 1]), label="made")
        odd = [Rejection(n, "halve", "odd") for n in "13"]
        assert_that(halved.rejected, equal_to(odd), label="rejected")


def test_a_crash_is_a_rejection_and_the_rest_goes_on() -> None:
    with beam.Pipeline(runner="FnApiRunner") as pipeline:
        inverted = pipeline | beam.Create([0, 2]) | Attempt(inverse)
        assert_that(inverted.made, equal_to([0.5]), label="made")
        text = "ZeroDivisionError('division by zero')"
        crash = Rejection("0", "inverse", "crashed", text)
        assert_that(inverted.rejected, equal_to([crash]), label="rejected")


def test_every_element_is_counted_once_and_timed() -> None:
    pipeline = beam.Pipeline(runner="FnApiRunner")
    _ = pipeline | beam.Create([1, 2, 0]) | Attempt(halve, stage="half")
    result = pipeline.run()
    result.wait_until_finish()
    metrics = result.metrics().query()
    counted = {m.key.metric.name: m.committed for m in metrics["counters"]}
    assert (counted["made"], counted["rejected"]) == (2, 1)
    told = {m.key.metric.name: m.committed for m in metrics["distributions"]}
    assert told["milliseconds"].count == 3
    assert sum(n for name, n in counted.items() if edge(name) is not None) == 3


@pytest.mark.parametrize("element", [("993", 1), "993", (("993", 2), 1)])
def test_a_grouped_element_is_named_by_its_key(element: object) -> None:
    assert subject(element) == "993"
