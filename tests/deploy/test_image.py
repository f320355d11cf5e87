"""The image's recipe: locked by hash, no torch, not root; Flink's options are known.

What can't be known without Docker is checked by `deploy/check.sh`, which CI runs.
"""

import re
import tomllib
from typing import Any

import pytest
import yaml

from pipelines.build.options import options
from tests.data import ROOT

DEPLOY = ROOT / "deploy"
LOCKS = ("nostalgin.lock", "gcp.lock", "tools.lock")
RECIPE = (DEPLOY / "image/Dockerfile").read_text()
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
CRD = {  # of FlinkDeployment v1beta1's spec, by the operator's reference
    "flinkConfiguration",
    "flinkVersion",
    "image",
    "imagePullPolicy",
    "ingress",
    "job",
    "jobManager",
    "logConfiguration",
    "mode",
    "podTemplate",
    "restartNonce",
    "serviceAccount",
    "taskManager",
}


def locked(lock: str) -> dict[str, list[str]]:
    """Read a lock: what stands below each package."""
    found: dict[str, list[str]] = {}
    for line in (DEPLOY / "image" / lock).read_text().splitlines():
        if not line.startswith((" ", "#")):
            name, _, _ = line.partition("==")
            mine = found[name.strip().split("[")[0]] = []
        elif line.strip().startswith("--hash"):
            mine.append(line.strip())
    return found


@pytest.mark.parametrize("lock", LOCKS)
def test_each_package_is_locked_by_hash(lock: str) -> None:
    found = locked(lock)
    assert found
    assert all(found.values())
    assert not [name for name in found if re.match("torch|nvidia|triton", name)]


@pytest.mark.parametrize("lock", LOCKS[:2])
def test_the_lock_holds_what_the_project_asks_for(lock: str) -> None:
    asked = {
        re.split(r"[\[<>=~! ;]", one)[0].casefold() for one in PROJECT["dependencies"]
    }
    assert asked <= set(locked(lock))


def stages() -> dict[str, str]:
    """Part the Dockerfile into its stages."""
    parts = re.split(r"^FROM (.*)$", RECIPE, flags=re.MULTILINE)[1:]
    heads, bodies = parts[::2], parts[1::2]
    return {h.split(" AS ")[1]: b for h, b in zip(heads, bodies, strict=True)}


@pytest.mark.parametrize("stage", ["nostalgin", "dataflow"])
def test_what_is_run_is_run_by_nobody_in_particular(stage: str) -> None:
    body = stages()[stage]
    assert "USER 1000" in body
    assert body.index("USER 1000") < body.index("ENTRYPOINT")
    assert "useradd" in stages()["bare"]


def test_what_is_installed_is_installed_from_a_lock() -> None:
    runs = re.findall(r"pip install[^&\n]*", RECIPE)
    assert len(runs) == 4
    assert all("--require-hashes" in one or "--no-deps" in one for one in runs)


def test_each_file_that_is_copied_is_there_and_not_ignored() -> None:
    ignored = (DEPLOY / "image/Dockerfile.dockerignore").read_text().splitlines()
    let = [one.removeprefix("!") for one in ignored if one.startswith("!")]
    for line in re.findall(r"^COPY (?!--from)(.*)$", RECIPE, flags=re.MULTILINE):
        for name in line.split()[:-1]:
            assert (ROOT / name).exists(), name
            top = [one for one in let if name.startswith(one.rstrip("*.lock"))]
            assert top, name


def composed() -> dict[str, Any]:
    return yaml.safe_load((DEPLOY / "flink/compose.yaml").read_text())["services"]


def test_compose_builds_by_options_that_are_known() -> None:
    told = [one for one in composed()["build"]["command"] if one.startswith("--")]
    made = options("c", beam=[one for one in told if one != "--json"])
    assert made.get_all_options()["environment_type"] == "EXTERNAL"


def test_each_task_manager_of_compose_has_one_slot_and_a_pool_of_its_own() -> None:
    services = composed()
    slots = services["taskmanager"]["environment"]["FLINK_PROPERTIES"]
    assert "taskmanager.numberOfTaskSlots: 1" in slots
    assert services["workers"]["network_mode"] == "service:taskmanager"
    assert services["workers"]["command"][0] == "workers"


def test_the_flink_deployment_has_the_operator_s_fields_alone() -> None:
    told = yaml.safe_load((DEPLOY / "kubernetes/flink.yaml").read_text())
    assert told["apiVersion"] == "flink.apache.org/v1beta1"
    assert set(told["spec"]) <= CRD
    assert {"image", "flinkVersion", "serviceAccount"} <= set(told["spec"])
    for part in ("jobManager", "taskManager"):
        manager = told["spec"][part]
        assert set(manager) <= {"replicas", "resource", "podTemplate"}
        assert set(manager["resource"]) <= {"cpu", "memory", "ephemeralStorage"}
