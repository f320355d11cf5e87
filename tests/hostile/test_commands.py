"""Whatever a command is given, it ends in time, says why, and touches nothing else."""

import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.hostile import catalogues, folders, manifests, networks, options, outputs
from tests.hostile.case import Case, check, parameters


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    """A folder of its own, removed at once: some hold what few programs can remove."""
    yield tmp_path
    subprocess.run(["rm", "-rf", tmp_path], check=True)


@pytest.mark.parametrize("case", parameters("folder", folders.cases()))
def test_a_folder_is_indexed_or_refused_in_words(case: Case, folder: Path) -> None:
    if why := folders.excused(case.name):
        pytest.skip(why)
    check(case, folder)


@pytest.mark.parametrize("case", parameters("catalogue", catalogues.cases()))
def test_a_catalogue_is_read_or_refused_in_words(case: Case, folder: Path) -> None:
    check(case, folder)


@pytest.mark.parametrize("case", parameters("manifest", manifests.cases()))
def test_a_manifest_of_nothing_is_refused_in_words(case: Case, folder: Path) -> None:
    check(case, folder)


@pytest.mark.parametrize("case", parameters("network", networks.cases()))
def test_a_network_runs_or_is_refused_by_its_file(case: Case, folder: Path) -> None:
    check(case, folder)


@pytest.mark.parametrize("case", parameters("option", options.cases()))
def test_an_option_is_obeyed_or_refused_in_words(case: Case, folder: Path) -> None:
    check(case, folder)


@pytest.mark.parametrize("case", parameters("output", outputs.cases()))
def test_an_output_is_written_or_refused_and_nothing_else(
    case: Case, folder: Path
) -> None:
    if why := outputs.excused(case.name):
        pytest.skip(why)
    check(case, folder)
