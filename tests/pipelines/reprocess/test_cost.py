"""What a run is estimated to cost follows from what earlier runs were seen to spend."""

import json
from pathlib import Path

import pytest

from pipelines.build.took import Took
from pipelines.reprocess import cost
from pipelines.reprocess.cost import rates
from pipelines.store import Store
from tests.pipelines.cities import artifacts
from tests.pipelines.reprocess import changing
from tests.pipelines.reprocess.test_reprocess import current, redone

# CPU seconds that an element of each stage is said to have taken.
PAINTED = {
    "segment": 0.8,
    "matte": 0.5,
    "rectify": 0.4,
    "thumbnail": 0.1,
    "borrow": 0.01,
    "inpaint": 1.0,
    "assign": 0.3,
    "block": 0.6,
}
FACTOR = 1.6  # by which an estimate may be too high: it takes blocks for changed


def row(count: int, each_s: float) -> dict[str, object]:
    """Paint what a run tells of a stage."""
    ms = round(1000 * each_s)
    spans = Took.of({float(ms): count}, ms).told()
    return {"made": 99, "cpu_milliseconds": count * ms, "milliseconds": ms, **spans}


def told(store: Store, run: str, counts: dict[str, int], slow: float = 1.0) -> None:
    """Paint a run that worked on so many elements a stage."""
    stages = {name: row(n, slow * PAINTED[name]) for name, n in counts.items()}
    store.write_bytes(f"runs/{run}/run.json", json.dumps({"stages": stages}).encode())


def repainted(city: Path) -> None:
    """Let the published run have spent what is painted."""
    path = city / "runs" / current(city) / "run.json"
    known = json.loads(path.read_text())
    for name, one in known["stages"].items():
        if name in PAINTED:
            one["cpu_milliseconds"] = 1000 * PAINTED[name] * Took.read(one).count
    path.write_text(json.dumps(known))


def test_after_one_run_the_second_s_estimate_lies_within_a_factor(city: Path) -> None:
    repainted(city)
    before = {stage: len(artifacts(city, stage)) for stage in PAINTED}
    changing.add(city, "6_2.png", "6_2.png,6,2,Oak Street,4,7")
    done = redone(city)
    assert done.report is not None
    made = {stage: len(artifacts(city, stage)) - n for stage, n in before.items()}
    really = sum(PAINTED[stage] * n for stage, n in made.items())
    really += PAINTED["assign"] * done.plan.blocks
    assert done.plan.cpu_seconds is not None
    assert really <= done.plan.cpu_seconds <= FACTOR * really
    record = json.loads((city / "runs" / current(city) / "run.json").read_text())
    assert record["estimated"]["cpu_seconds"] == done.plan.cpu_seconds
    assert record["cpu_seconds"] == done.report.cpu_seconds > 0


def test_one_slow_run_among_others_moves_no_rate(tmp_path: Path) -> None:
    store, counts = Store(str(tmp_path)), dict.fromkeys(PAINTED, 10)
    for run in "abcd":
        told(store, run, counts)
    told(store, "slow", counts, slow=7)
    known = rates(store)
    assert known is not None
    assert known.cpu_s == pytest.approx(PAINTED)


def test_a_run_of_few_weighs_little_and_one_of_none_nothing(tmp_path: Path) -> None:
    store = Store(str(tmp_path))
    told(store, "large", dict.fromkeys(PAINTED, 100))
    for run in "abc":
        told(store, run, dict.fromkeys(PAINTED, 1), slow=7)
    told(store, "idle", dict.fromkeys(PAINTED, 0))
    known = rates(store)
    assert known is not None
    assert known.cpu_s == pytest.approx(PAINTED)
    assert known.of_photo == {"borrow": 1.0, "inpaint": 1.0}


def test_the_clock_is_that_of_the_run_which_is_most_alike() -> None:
    known = cost.Rates({}, {}, [(1.0, 20.0), (1000.0, 1500.0)])
    assert known.clock(2.0, 1) == pytest.approx(40)  # most of it is the start
    assert known.clock(800.0, 2) == pytest.approx(600)


@pytest.mark.parametrize(
    "torn", ["[]", '{"stages": 3}', '{"stages": {"segment": []}}', '{"stages": {}}']
)
def test_records_that_make_no_sense_estimate_nothing(tmp_path: Path, torn: str) -> None:
    store = Store(str(tmp_path))
    store.write_bytes("runs/a/run.json", torn.encode())
    assert rates(store) is None
