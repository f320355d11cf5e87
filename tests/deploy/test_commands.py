"""Each command in `deploy/` is one that the program knows, and versions are of now."""

import os
import re
import shlex
import subprocess
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer
import yaml
from packaging.requirements import Requirement

from pipelines.build.options import options
from pipelines.cli import app
from tests.data import ROOT
from tests.deploy.test_clusters import SBATCH, documents

DEPLOY = ROOT / "deploy"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
LOCKED = DEPLOY / "image" / "nostalgin.lock"
TOLD = """#!/bin/sh
for word in nostalgin "$@"; do printf '%s\\0' "$word"; done >> "$HEARD"
"""
GIVEN = {  # what a person sets
    "CITY": "/srv/city",
    "JOB_COMPLETION_INDEX": "2",
    "NOSTALGIN_CITY": "/srv/city",
    "NOSTALGIN_OPTIONS": "--direct_num_workers=4",
    "SLURM_ARRAY_TASK_ID": "3",
}
UNKNOWN: Any = typer.BadParameter.__base__  # a wrong usage of any kind


def heard(script: str, folder: Path) -> list[str]:
    """Run a script's shell text with a program that tells its words."""
    program = folder / "nostalgin"
    program.write_text(TOLD)
    program.chmod(0o755)
    env = GIVEN | {"PATH": f"{folder}:{os.environ['PATH']}", "HEARD": f"{folder}/heard"}
    subprocess.run(["/bin/sh", "-c", script], env=env, check=True)
    return (folder / "heard").read_bytes().decode().split("\0")[:-1]


def of_kubernetes(folder: Path) -> Iterator[list[str]]:
    for document in documents():
        spec = document["spec"].get("jobTemplate", document)["spec"]
        pod = spec.get("template", spec.get("taskManager", {}).get("podTemplate"))
        for container in pod["spec"]["containers"]:
            words = [*container.get("command", []), *container.get("args", [])]
            if words[:2] == ["/bin/sh", "-c"]:
                yield heard(words[2], folder)
            elif words:
                yield words


def of_compose() -> Iterator[list[str]]:
    text = re.sub(r"\$\{CITY[^}]*\}", GIVEN["CITY"], compose())
    for one in yaml.safe_load(text)["services"].values():
        if one["image"].startswith("nostalgin"):  # whose image begins so itself
            yield ["nostalgin", *one["command"]]


def compose() -> str:
    return (DEPLOY / "flink/compose.yaml").read_text()


def of_slurm(folder: Path) -> Iterator[list[str]]:
    (folder / "sbatch").write_text(SBATCH)
    (folder / "sbatch").chmod(0o755)
    said = folder / "said"
    env = GIVEN | {"PATH": f"{folder}:{os.environ['PATH']}", "SAID": str(said)}
    subprocess.run([DEPLOY / "slurm/city.sh", "16"], env=env, check=True)
    for one in said.read_text().split("---\n")[:-1]:
        (folder / "heard").unlink(missing_ok=True)
        yield heard(one.partition("--wrap=")[2], folder)


def of_airflow(folder: Path) -> Iterator[list[str]]:
    text = (DEPLOY / "airflow/nostalgin_dag.py").read_text()
    yield heard(text.split('COMMAND = """')[1].split('"""')[0], folder)


def of_comments() -> Iterator[list[str]]:
    """Read the commands that a file's head tells people to give."""
    for path in sorted(DEPLOY.rglob("*")):
        if path.suffix not in (".yaml", ".sh", ".py"):
            continue
        text = re.sub(r"\\\n#\s*", "", path.read_text())
        for line in re.findall(r"^#\s{2,}(nostalgin .*)$", text, re.MULTILINE):
            yield shlex.split(line)


@pytest.fixture
def every(tmp_path: Path) -> list[list[str]]:
    found = []
    for name, of in {"k": of_kubernetes, "s": of_slurm, "a": of_airflow}.items():
        folder = tmp_path / name
        folder.mkdir()
        for words in of(folder):
            (folder / "heard").unlink(missing_ok=True)
            found.append(words)
    return [*found, *of_compose(), *of_comments()]


def parsed(words: list[str]) -> Any:
    """Read a command as the program would, and do nothing."""
    group: Any = typer.main.get_command(app)
    above = group.make_context("nostalgin", list(words[1:]), resilient_parsing=False)
    name, command, rest = group.resolve_command(above, [*above._protected_args])
    del name
    return command.make_context(words[1], [*rest, *above.args], parent=above)


def test_each_command_is_one_that_the_program_knows(every: list[list[str]]) -> None:
    assert {words[1] for words in every} >= {"build", "schedule", "reprocess"}
    assert len(every) >= 9
    for words in every:
        assert words[0] == "nostalgin"
        context = parsed(words)
        if "city" in context.params:
            options(context.params["city"], beam=context.args)
        else:
            assert not context.args, words


def test_a_command_that_nobody_knows_is_found() -> None:
    with pytest.raises(UNKNOWN):
        parsed(["nostalgin", "bulid", "city"])
    with pytest.raises(UNKNOWN):
        parsed(["nostalgin", "build", "city", "--shard"])
    with pytest.raises(ValueError, match="neither nostalgin nor Beam"):
        options("city", beam=parsed(["nostalgin", "build", "c", "--budgt=3"]).args)


def texts() -> dict[str, str]:
    names = ("*.yaml", "*.py", "*.sh", "Dockerfile", "*.md")
    files = [path for name in names for path in DEPLOY.rglob(name)]
    files += [ROOT / "README.md", ROOT / "docs/sizing.md"]
    return {str(path.relative_to(ROOT)): path.read_text() for path in files}


def test_images_are_tagged_with_the_version_of_now() -> None:
    told = [
        (name, tag)
        for name, text in texts().items()
        for tag in re.findall(r"nostalgin(?:-dataflow)?:(\d[\w.]*)", text)
    ]
    assert len(told) > 6
    assert {tag for _, tag in told} == {PROJECT["version"]}


def test_beam_is_of_one_version_everywhere() -> None:
    (locked,) = re.findall(r"^apache-beam==(\S+)", LOCKED.read_text(), re.MULTILINE)
    (ours,) = [one for one in PROJECT["dependencies"] if one.startswith("apache-beam")]
    assert Requirement(ours).specifier.contains(locked)
    patterns = (r"beam_\S+:(\d+\.\d+\.\d+)", r"job-server-(\d+\.\d+\.\d+)\.jar")
    told = {
        found
        for text in (*texts().values(), (ROOT / "Makefile").read_text())
        for pattern in (*patterns, r"^BEAM := (\S+)")
        for found in re.findall(pattern, text, re.MULTILINE)
    }
    assert told == {locked}


@pytest.mark.parametrize("lock", ["nostalgin.lock", "gcp.lock"])
def test_the_locks_hold_versions_that_the_project_takes(lock: str) -> None:
    text = (DEPLOY / "image" / lock).read_text()
    held = dict(re.findall(r"^([\w.-]+)(?:\[[^]]*\])?==([^\s;]+)", text, re.MULTILINE))
    for one in map(Requirement, PROJECT["dependencies"]):
        assert one.specifier.contains(held[one.name.casefold()]), one


def test_what_the_wheel_is_built_from_is_copied() -> None:
    """What `pyproject.toml` names for the wheel reaches the stage that builds it."""
    recipe = (DEPLOY / "image/Dockerfile").read_text()
    (stage,) = re.findall(r"AS wheel\n(.*?)\nFROM", recipe, re.DOTALL)
    copied = {
        w
        for line in re.findall(r"^COPY (.*)$", stage, re.MULTILINE)
        for w in line.split()
    }
    whole = tomllib.loads((ROOT / "pyproject.toml").read_text())
    wheel = whole["tool"]["hatch"]["build"]["targets"]["wheel"]
    named = [*wheel["packages"], wheel["hooks"]["custom"]["path"], PROJECT["readme"]]
    assert {*named, *PROJECT["license-files"], "pyproject.toml"} <= copied
    assert "pipelines/site/viewer_dist" in copied  # of the viewer's own stage
