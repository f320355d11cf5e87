"""Where a published city came from, as W3C PROV-JSON: files, networks, parameters.

The same run gives the same bytes: clock times stand in its run.json alone.
"""

import contextlib
import hashlib
import json
from pathlib import Path
from typing import Final

import pyarrow as pa

from pipelines.formats.published import Json, Published, Unexportable
from pipelines.models import NETWORKS, Models, Unlocked
from pipelines.site import safe
from pipelines.store import Damaged, Store, runs

STAGES: Final = ("segment", "matte", "rectify", "borrow", "inpaint", "block")
MANIFESTS: Final = ("manifest.csv", "manifest.parquet")
PREFIXES: Final = {
    name: f"urn:nostalgin:{name}:"
    for name in ("file", "photo", "network", "building", "model", "stage", "run")
} | {"nostalgin": "urn:nostalgin:"}
SOFTWARE: Final = "nostalgin:software"


def read(city: Path, site: Published) -> Json:
    """Tell a published run's provenance.

    Raises:
        Unexportable: if its tables are not there, or are another city's than the site.
    """
    store = Store(str(city))
    try:
        run = runs.shown(store)
        noted = json.loads(store.read_bytes(f"runs/{run}/run.json"))
        names = ("photos", "buildings", "blocks")
        told = {name: runs.read_table(store, run, name) for name in names}
    except (OSError, Damaged, pa.ArrowException, ValueError) as problem:
        words = f"{city} has no tables of what was built: build it again ({problem})"
        raise Unexportable(words) from problem
    for block in site.blocks:
        sha256 = hashlib.sha256(site.glb(block)).hexdigest()
        row = next((o for o in told["blocks"] if o["block"] == block["name"]), None)
        if row is None or row["sha256"] != sha256:
            raise Unexportable(f"{block['uri']} is not of run {run}: build again")
    return Writer(run, told, noted).written(manifests(city))


def manifests(city: Path) -> dict[str, str]:
    """Hash the manifest in both its forms."""
    paths = [city / name for name in MANIFESTS]
    return {
        one.name: hashlib.sha256(one.read_bytes()).hexdigest()
        for one in paths
        if one.is_file()
    }


class Writer:
    """A run's tables, while they become a PROV document."""

    def __init__(self, run: str, told: dict[str, list[Json]], noted: Json) -> None:
        """Begin with nothing but the program."""
        self._run, self._told, self._noted = f"run:{run}", told, noted
        self._keys = {(one["root"], one["name"]): one["key"] for one in told["photos"]}
        self._said: dict[str, Json] = {
            "prefix": dict(PREFIXES),
            "agent": {SOFTWARE: {"prov:type": "prov:SoftwareAgent"}},
            "entity": {},
            "activity": {},
        }

    def written(self, manifest: dict[str, str]) -> Json:
        """Write all of it."""
        self._said["activity"][self._run] = {"prov:label": "build"}
        self._say("wasAssociatedWith", activity=self._run, agent=SOFTWARE)
        for name, sha256 in manifest.items():
            self._input(f"file:{name}", name, sha256)
        for one in self._told["photos"]:
            self._input(f"photo:{one['key']}", one["name"], one["sha256"])
        self._stages()
        for row in self._told["blocks"]:
            self._block(row)
        for row in self._told["buildings"]:
            self._building(row)
        return self._said

    def _input(self, name: str, label: str, sha256: str) -> None:
        told = {"prov:label": label, "nostalgin:sha256": sha256}
        self._said["entity"][name] = told
        self._say("used", activity=self._run, entity=name)

    def _stages(self) -> None:
        """Tell each stage's version, and of a version that is present all it says.

        A version is a hash of parameters and network, so equal ones have equal both.
        """
        from pipelines.index import known_watermarks, watermark_content
        from pipelines.index import watermark_sha256 as hashed
        from pipelines.store.versions import MARKED, PARAMETERS, version

        names = ("", *known_watermarks())
        marks = {name: hashed(watermark_content(name)) for name in names}
        models = Models(self._noted.get("options", {}).get("models") or "")
        for stage in STAGES:
            name = f"stage:{stage}"
            made_by = self._noted.get("versions", {}).get(stage, "")
            told = {"prov:label": stage, "nostalgin:version": made_by}
            with contextlib.suppress(Unlocked):  # networks that were moved away since
                for mark, sha256 in marks.items():
                    if version(stage, models, sha256) == made_by:
                        told["nostalgin:parameters"] = PARAMETERS[stage]
                        off = {"nostalgin:watermark": mark} if stage == MARKED else {}
                        told |= off if mark else {}
                if stage in NETWORKS and "nostalgin:parameters" in told:
                    self._network(stage, models.sha256(stage))
            self._said["activity"][name] = told
            self._say("wasInformedBy", informed=self._run, informant=name)

    def _network(self, stage: str, sha256: str) -> None:
        entity = f"network:{stage}.onnx"
        label = {"prov:label": f"{stage}.onnx", "nostalgin:sha256": sha256}
        self._said["entity"][entity] = label
        self._say("used", activity=f"stage:{stage}", entity=entity)

    def _block(self, row: Json) -> None:
        name = model_of(row["block"])
        told = {"prov:label": row["block"], "nostalgin:sha256": row["sha256"]}
        self._said["entity"][name] = told | {"nostalgin:credit": row["credit"] or ""}
        self._say("wasGeneratedBy", entity=name, activity="stage:block")

    def _building(self, row: Json) -> None:
        name = f"building:{safe(row['building_id'])}"
        self._said["entity"][name] = {
            "prov:label": row["building_id"],
            "nostalgin:height_m": row["height_m"],
            "nostalgin:assumed": row["assumed"],
        }
        model = model_of(row["block"])
        self._say("hadMember", collection=model, entity=name)
        worn = zip(
            row["roots"], row["photos"], row["facades"], row["scores"], strict=True
        )
        for root, photo, facade, score in worn:
            key = self._keys[root, photo]
            used = {"usedEntity": f"photo:{key}", "generatedEntity": name}
            more = {"nostalgin:facade": facade, "nostalgin:score": score}
            self._say("wasDerivedFrom", more, **used)

    def _say(self, relation: str, more: Json | None = None, **ends: str) -> None:
        there = self._said.setdefault(relation, {})
        told: Json = {f"prov:{end}": name for end, name in ends.items()}
        there[f"_:{relation}{len(there)}"] = told | (more or {})


def model_of(block: str) -> str:
    """Name a block's model in a way that no letter of it can spoil."""
    return f"model:{safe(block)}"
