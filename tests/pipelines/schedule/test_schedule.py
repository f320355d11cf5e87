"""Each time comes once, those that were missed are made up for once, by any clock."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from pipelines.schedule import (
    NoCron,
    Record,
    Schedule,
    recorded,
    run_due,
    run_on,
    ticks_between,
)
from pipelines.store import Store

NIGHT = "17 3 * * *"
NOON = datetime(2026, 11, 22, 12, tzinfo=UTC)
DAY = timedelta(days=1)


class Painted:
    """A clock that goes by being waited for."""

    def __init__(self, now: datetime, end: datetime) -> None:
        self.time, self.end, self.naps = now, end, 0

    def now(self) -> datetime:
        return self.time

    def sleep(self, seconds: float) -> None:
        self.naps += 1
        self.time += timedelta(seconds=max(seconds, 1))

    def stopped(self) -> bool:
        return self.time >= self.end


def worked(outcome: str = "done") -> Record:
    return Record("", "", "", outcome)


def scheduled(folder: Path, **more: float) -> Schedule:
    return Schedule(Store(str(folder)), NIGHT, **more)


def ticks(schedule: Schedule) -> list[datetime]:
    return [one.when for one in recorded(schedule.store)]


def test_each_night_has_its_run(tmp_path: Path) -> None:
    schedule = scheduled(tmp_path)
    run_on(schedule, Painted(NOON, NOON + 3 * DAY), worked)
    assert [one.day for one in ticks(schedule)] == [23, 24, 25]
    assert {one.strftime("%H:%M") for one in ticks(schedule)} == {"03:17"}


def test_what_was_missed_is_made_up_for_once(tmp_path: Path) -> None:
    schedule = scheduled(tmp_path)
    run_on(schedule, Painted(NOON, NOON + DAY), worked)
    run_on(schedule, Painted(NOON + 5 * DAY, NOON + 5 * DAY + DAY / 24), worked)
    (_, last) = recorded(schedule.store)
    assert (last.when.day, last.missed) == (27, 3)


def test_a_run_that_takes_longer_than_a_day_is_followed_by_one(tmp_path: Path) -> None:
    schedule = scheduled(tmp_path)
    clock = Painted(NOON, NOON + 5 * DAY)

    def long() -> Record:
        clock.time += 2.5 * DAY
        return worked()

    run_on(schedule, clock, long)
    assert [one.missed for one in recorded(schedule.store)] == [0, 1]


def test_one_that_failed_is_recorded_and_the_next_goes_on(tmp_path: Path) -> None:
    schedule = scheduled(tmp_path)
    outcomes = iter(("failed", "done"))
    run_on(schedule, Painted(NOON, NOON + 2 * DAY), lambda: worked(next(outcomes)))
    assert [one.outcome for one in recorded(schedule.store)] == ["failed", "done"]


def test_one_that_was_stopped_is_due_again_at_once(tmp_path: Path) -> None:
    schedule, clock = scheduled(tmp_path), Painted(NOON, NOON)
    run_due(schedule, clock, worked, None)
    clock.time += DAY
    for outcome, missed in (("stopped", 0), ("stopped", 1), ("done", 1)):
        assert run_due(schedule, clock, lambda outcome=outcome: worked(outcome), None)
        assert recorded(schedule.store)[-1].missed == missed
        clock.time += DAY if missed == 0 else timedelta(minutes=1)
    assert not run_due(schedule, clock, worked, None)


def test_once_runs_at_first_and_then_only_when_it_is_due(tmp_path: Path) -> None:
    schedule = scheduled(tmp_path)
    clock = Painted(NOON, NOON)
    assert run_due(schedule, clock, worked, None)
    assert not run_due(schedule, clock, worked, None)
    clock.time += DAY
    assert run_due(schedule, clock, worked, None)
    assert not run_due(schedule, clock, worked, None)


def test_jitter_puts_a_time_off_by_no_more_and_always_the_same(tmp_path: Path) -> None:
    schedule = scheduled(tmp_path, jitter_s=600)
    delays = [schedule.delay(NOON + n * DAY) for n in range(50)]
    assert max(delays) < timedelta(seconds=600)
    assert len(set(delays)) == 50
    assert delays[0] == schedule.delay(NOON)
    tick = datetime(2026, 11, 23, 3, 17, tzinfo=UTC)
    late = tick + schedule.delay(tick)
    assert schedule.due(late - timedelta(seconds=1), NOON) == []
    assert schedule.due(late, NOON) == [tick]


def test_a_time_that_the_clocks_skip_comes_and_one_shown_twice_comes_once() -> None:
    spring = datetime(2026, 3, 28, 12, tzinfo=UTC)
    autumn = datetime(2026, 10, 24, 12, tzinfo=UTC)
    cron, zone = "30 2 * * *", "Europe/Berlin"
    assert len(ticks_between(cron, zone, spring, spring + DAY)) == 1
    assert len(ticks_between(cron, zone, autumn, autumn + DAY)) == 1


@pytest.mark.parametrize(
    ("cron", "zone"), [("nonsense", "UTC"), ("99 3 * * *", "UTC"), (NIGHT, "Nowhere")]
)
def test_what_is_no_cron_expression_is_told(cron: str, zone: str) -> None:
    with pytest.raises(NoCron, match="write it as"):
        ticks_between(cron, zone, NOON, NOON + DAY)


@pytest.mark.parametrize(
    "spoiled", ['[{"tick": 3}]', "[", "{}", '[{"tick": "soon"}]', "[" * 100_000]
)
def test_a_spoiled_record_tells_of_none_and_is_put_aside(
    tmp_path: Path, spoiled: str
) -> None:
    (tmp_path / "schedule.json").write_text(spoiled)
    schedule = scheduled(tmp_path)
    assert recorded(schedule.store) == []
    assert run_due(schedule, Painted(NOON, NOON), worked, None)
    assert ticks(schedule) == [NOON]
    assert (tmp_path / "schedule.json.spoiled").read_text() == spoiled


def test_what_a_later_release_adds_to_a_record_does_no_harm(tmp_path: Path) -> None:
    schedule, clock = scheduled(tmp_path), Painted(NOON, NOON)
    run_due(schedule, clock, worked, None)
    path = tmp_path / "schedule.json"
    path.write_text(path.read_text().replace('"tick"', '"mood": "good", "tick"'))
    assert ticks(schedule) == [NOON]
    assert not run_due(schedule, clock, worked, None)


def test_what_can_not_be_read_is_not_taken_for_none(tmp_path: Path) -> None:
    (tmp_path / "schedule.json").mkdir()
    with pytest.raises(IsADirectoryError):
        recorded(Store(str(tmp_path)))
