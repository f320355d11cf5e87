"""metrics.prom is read by Prometheus's own parser, and holds what run.json tells."""

import json
from calendar import timegm
from pathlib import Path
from time import strptime
from typing import Any

import pytest
from prometheus_client.parser import text_string_to_metric_families

from pipelines.build import prometheus
from tests.pipelines.cities import built, copied

Samples = dict[tuple[str, str, str], float]  # name, stage or process, bound


def samples(text: str) -> Samples:
    """Parse a file of the text format 0.0.4."""
    return {
        (
            one.name,
            one.labels.get("stage", one.labels.get("process", "")),
            one.labels.get("le", ""),
        ): one.value
        for family in text_string_to_metric_families(text)
        for one in family.samples
    }


def record(city: Path) -> dict[str, Any]:
    run = (city / "CURRENT").read_text().strip()
    return json.loads((city / "runs" / run / "run.json").read_text())


def test_each_family_has_the_type_that_a_textfile_collector_reads() -> None:
    stage = {"made": 4, "milliseconds": 9, "longest_ms": 9}
    told = {"seconds": 1.0, "stages": {"matte": stage}, "memory_mb": {"driver": 1}}
    text = prometheus.text(told, "city", "", succeeded={}).decode()
    types = {f.name: f.type for f in text_string_to_metric_families(text)}
    for word in prometheus.COUNTERS:
        assert types[f"nostalgin_{word}"] == "counter"
    assert types["nostalgin_stage_seconds"] == "histogram"
    assert types["nostalgin_run_seconds"] == "gauge"
    assert "unknown" not in types.values()
    assert "# EOF" not in text


@pytest.fixture(scope="module")
def first(city: Path) -> tuple[Samples, dict[str, Any]]:
    """What the first run told, as read back."""
    return samples((city / "metrics.prom").read_text()), record(city)


def test_the_counters_are_those_of_the_run(
    first: tuple[Samples, dict[str, Any]],
) -> None:
    found, told = first
    assert found["nostalgin_made_total", "segment", ""] == 4
    assert found["nostalgin_skipped_total", "segment", ""] == 0
    for stage, one in told["stages"].items():
        assert found["nostalgin_made_total", stage, ""] == one["made"]


def test_a_histogram_holds_each_element_that_was_worked_on(
    first: tuple[Samples, dict[str, Any]],
) -> None:
    found, told = first
    for stage in ("segment", "matte", "rectify"):
        assert found["nostalgin_stage_seconds_count", stage, ""] == 4
        spent = told["stages"][stage]["milliseconds"] / 1000
        assert found["nostalgin_stage_seconds_sum", stage, ""] == spent
        longest = told["stages"][stage]["longest_ms"]
        bounds = {
            float(le): n
            for (name, whose, le), n in found.items()
            if name == "nostalgin_stage_seconds_bucket" and whose == stage
        }
        assert [n for _, n in sorted(bounds.items())] == sorted(bounds.values())
        assert all(n == 4 for le, n in bounds.items() if le * 1000 >= longest)
        assert 0 < told["stages"][stage]["median_ms"] <= longest


def test_memory_rate_and_times_are_told(
    first: tuple[Samples, dict[str, Any]],
) -> None:
    found, told = first
    for process in ("driver", "stage", "worker"):
        assert found["nostalgin_memory_peak_bytes", process, ""] > 50e6
    rate = 60 * 4 / told["seconds"]
    assert found["nostalgin_photos_per_minute", "", ""] == pytest.approx(rate)
    began = timegm(strptime(told["began"], "%Y-%m-%dT%H:%M:%SZ"))
    ended = began + told["seconds"]
    assert found["nostalgin_last_success_timestamp_seconds", "", ""] == ended
    assert found["nostalgin_made_created", "segment", ""] == began


def test_a_second_run_skips_what_is_there_and_takes_no_time_for_it(
    city: Path, first: tuple[Samples, dict[str, Any]]
) -> None:
    del first
    built(city)
    found = samples((city / "metrics.prom").read_text())
    for stage in ("segment", "matte", "rectify", "thumbnail"):
        assert found["nostalgin_skipped_total", stage, ""] == 4
        assert found["nostalgin_stage_seconds_count", stage, ""] == 0
    assert found["nostalgin_skipped_total", "block", ""] == 2
    assert found["nostalgin_photos_per_minute", "", ""] == 0


def test_a_shard_has_a_file_of_its_own_and_no_success(
    city: Path, tmp_path: Path
) -> None:
    other = copied(city, tmp_path)
    built(other, shard="1/2")
    assert not (other / "metrics.prom").exists()
    text = (other / "metrics.1-of-2.prom").read_text()
    assert 'shard="1/2"' in text
    assert samples(text)["nostalgin_last_success_timestamp_seconds", "", ""] == 0


def test_a_name_of_a_city_can_break_no_line() -> None:
    told = {"began": "2026-11-23T10:00:00Z", "seconds": 1.0, "stages": {}}
    name = 'a"b\\c\nnostalgin_forged 1'
    text = prometheus.text(told, name, "", succeeded={}).decode()
    families = list(text_string_to_metric_families(text))
    cities = {one.labels["city"] for f in families for one in f.samples}
    assert cities == {name}
