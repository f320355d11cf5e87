"""Ask for known holes in the packages of this environment; say so if nobody answers.

`pip-audit` ends well also where it was told nothing: a package that its service does
not know is skipped, and behind a mirror without advisories these are all. So its report
is counted here: what was asked, what was not, and what was found.

Exit codes: 0 nothing known, 1 holes are known, 2 nothing could be asked.
"""

import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

SERVICES: Final = ("pypi", "osv")  # asked in this order, until one answers
OWN: Final = "nostalgin"


@dataclass(frozen=True)
class Audit:
    """What one service told of an environment."""

    asked: int  # packages that it knows
    skipped: tuple[str, ...]  # packages that it could not be asked about, with reasons
    holes: tuple[str, ...]


def main(services: Sequence[str] = SERVICES) -> int:
    """Ask one service after the other, and tell what came out."""
    for service in services:
        audit = counted(report(service))
        if not audit.asked:
            say(f"audit: {service} told nothing of any package")
            continue
        for one in audit.skipped:
            say(f"audit: not asked: {one}")
        for one in audit.holes:
            say(f"audit: {one}")
        say(f"audit: {service}: {audit.asked} packages, {len(audit.holes)} known holes")
        return 1 if audit.holes else 0
    say("audit: NOTHING was audited: no advisory service can be reached from here")
    return 2


def report(service: str) -> dict[str, Any]:
    """Run pip-audit; an empty report if its service can't be reached."""
    words = ["--format", "json", "--progress-spinner", "off"]
    done = subprocess.run(
        [sys.executable, "-m", "pip_audit", "--vulnerability-service", service, *words],
        capture_output=True,
        text=True,
        check=False,
    )
    try:
        return json.loads(done.stdout)
    except ValueError:
        say("\n".join(done.stderr.strip().splitlines()[-1:]))
        return {}


def counted(told: dict[str, Any]) -> Audit:
    """Count a report of pip-audit."""
    packages = told.get("dependencies", [])
    skipped = [one for one in packages if "skip_reason" in one and one["name"] != OWN]
    return Audit(
        asked=sum("version" in one for one in packages),
        skipped=tuple(f"{one['name']}: {one['skip_reason']}" for one in skipped),
        holes=tuple(
            f"{one['name']} {one['version']}: {hole['id']}: mended in "
            f"{', '.join(hole['fix_versions']) or 'no release yet'}"
            for one in packages
            for hole in one.get("vulns", ())
        ),
    )


def say(line: str) -> None:
    """Print a line."""
    sys.stdout.write(f"{line}\n")


if __name__ == "__main__":
    sys.exit(main())
