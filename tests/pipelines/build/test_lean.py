"""A process of a run loads what it needs; what it does not can still be had."""

import subprocess
import sys

from tests.data import ROOT

LATE = (
    *("pymongo", "bson", "boto3", "requests", "apache_beam.io.gcp.bigquery"),
    *("apache_beam.runners.portability.fn_api_runner.fn_runner", "prometheus_client"),
    *("pyparsing", "proto.message", "beartype.door", "numpy.f2py.f2py2e"),
    *("scipy.optimize", "scipy.cluster", "scipy.spatial", "pydantic", "pyproj"),
)
WORKER = "import pipelines.build.blocks, apache_beam.runners.worker.sdk_worker_main"


def loaded_after(statement: str) -> tuple[set[str], str]:
    """Run a statement in a fresh interpreter: what came along, and what it said."""
    known = f"import sys; {statement}; print(*(m for m in {LATE} if m in sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", known],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=True,
    )
    return set(done.stdout.split()), done.stderr


def test_a_worker_loads_no_client_and_nothing_that_only_the_driver_needs() -> None:
    loaded, said = loaded_after(WORKER)
    assert loaded == set()
    assert "bson" not in said


def test_what_stands_in_is_loaded_when_it_is_used() -> None:
    used = (
        "import collections, numpy; from apache_beam.internal import http_client; "
        "from apache_beam.coders import coders; "
        "from apache_beam.typehints.typehints import is_consistent_with as fits; "
        "assert fits(collections.OrderedDict, dict); assert not fits(str, bytes); "
        "assert http_client.get_new_http(); assert coders.proto.Message; "
        "assert numpy.f2py.f2py2e"
    )
    loaded, _ = loaded_after(f"{WORKER}; {used}")
    assert loaded >= {"pyparsing", "proto.message", "beartype.door"}


def test_what_was_left_out_can_be_had_afterwards() -> None:
    later = ("pymongo", "boto3", "apache_beam.io.gcp.bigquery", "scipy.optimize")
    loaded, _ = loaded_after(f"{WORKER}; import {', '.join(later)}")
    assert loaded >= {*later, "bson", "requests"}
