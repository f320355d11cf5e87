"""Several processes at once on one city folder, one of them killed: the same bytes."""

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from pipelines.index import manifest
from pipelines.store import Store
from tests.pipelines import buckets, gcs, s3
from tests.pipelines.cities import artifacts, copied, tree
from tests.pipelines.gcs import google
from tests.pipelines.s3 import bucket

__all__ = ["bucket", "google"]

# The first has three photos, the second one, the last none.
SHARDS = (3, 1, 2)
WAIT_S = 300.0

pytestmark = pytest.mark.timeout(900)  # five processes start, two at a time


def started(city: str, models: Path, shard: int) -> subprocess.Popen[str]:
    words = ["build", city, "--models", str(models)]
    parts = ["--shard", f"{shard}/{len(SHARDS)}"] if shard else []
    command = [sys.executable, "-m", "pipelines.cli", *words, *parts]
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True)


def ended(one: subprocess.Popen[str]) -> str:
    said = one.communicate(timeout=WAIT_S)[1]
    assert one.returncode == 0, said
    return said


def run_shards(city: str, models: Path, made: Callable[[], int]) -> str:
    """Run all shards at once, kill the first after its first artifact, and go on.

    Returns what was said.
    """
    first, *others = [started(city, models, one) for one in SHARDS]
    until = time.monotonic() + WAIT_S
    while not made() and first.poll() is None and time.monotonic() < until:
        time.sleep(0.02)
    first.kill()
    said = [first.communicate()[1]]
    assert made(), said
    said.extend(map(ended, others))
    # what was killed, and the last run, which publishes
    said.extend(ended(started(city, models, shard)) for shard in (SHARDS[0], 0))
    return "".join(said)


def test_shards_of_which_one_is_killed_make_the_same_bytes(
    city: Path, tmp_path: Path
) -> None:
    other = copied(city, tmp_path)
    made = lambda: len(artifacts(other, ""))  # noqa: E731
    run_shards(str(other), tmp_path / "models", made)
    same = {name: one for name, one in tree(other).items() if name in tree(city)}
    assert same == tree(city)
    assert not [name for name in tree(other) if name.endswith(".partial")]


@pytest.mark.parametrize(
    ("server", "secret"),
    [
        ("bucket", s3.SECRET),
        pytest.param("google", gcs.PRIVATE, marks=gcs.needs_server),
    ],
)
def test_shards_in_a_bucket_make_the_same_bytes_and_tell_no_secret(
    city: Path,
    tmp_path: Path,
    server: str,
    secret: str,
    request: pytest.FixtureRequest,
) -> None:
    root = request.getfixturevalue(server)
    copied(city, tmp_path)
    for name in (manifest.PARQUET, manifest.CSV):
        buckets.put(root, city / name, f"city/{name}")
    for path in (city.parent / "photos").iterdir():
        buckets.put(root, path, f"photos/{path.name}")
    rows = [
        manifest.typed(row) | {"root": "../photos"}
        for row in manifest.read(Store(str(city))).rows
    ]
    manifest.write(Store(f"{root}/city"), rows)
    seen = lambda: buckets.tree(root, "city")  # noqa: E731
    made = lambda: sum(name.startswith("artifacts") for name in seen())  # noqa: E731
    said = run_shards(f"{root}/city", tmp_path / "models", made)
    ours = {n: one for n, one in tree(city).items() if n.startswith("artifacts")}
    assert {n: o for n, o in seen().items() if n in ours} == ours
    assert secret not in said
    told = buckets.objects(root, "city")
    assert "CURRENT" in told
    assert not [name for name, data in told.items() if secret.encode() in data]
