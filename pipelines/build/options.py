"""What a build is told, as Beam options, so that any runner's launcher can tell it."""

import argparse
import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from apache_beam.options.pipeline_options import (
    DirectOptions,
    PipelineOptions,
    PrismRunnerOptions,
    StandardOptions,
)
from apache_beam.runners.runner import PipelineRunner, create_runner

from pipelines.build import cluster
from pipelines.build.embedded import EMBEDDED
from pipelines.build.supervisor import Limits
from pipelines.store import SECRETIVE, secretive, textual

SCHEME: Final = re.compile(r"[a-z][a-z0-9+.-]*")  # RFC 3986, section 3.1
OURS: Final = ("--city", "--models", "--shard", "--allow_schemes")
DIGITS: Final = 9  # of a part's number
# What people call it; Beam itself would fetch another runner for these names.
ALIASES: Final = ("DirectRunner", "BundleBasedDirectRunner", "", None)


class CityOptions(PipelineOptions):
    """The city folder, and which part of it to build."""

    @classmethod
    def _add_argparse_args(cls, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("--city", help="the city folder")
        parser.add_argument("--models", default="", help="folder of other networks")
        parser.add_argument("--shard", default="", help="part of the blocks, as 3/16")
        most = Limits()
        parser.add_argument(
            "--stage_seconds",
            type=float,
            default=most.seconds,
            help="what a stage may take for one element; 0: it has no own process",
        )
        parser.add_argument(
            "--stage_gigabytes",
            type=float,
            default=most.gigabytes,
            help="the memory that a stage may take",
        )
        parser.add_argument(
            "--retry", action="store_true", help="try again what was put aside"
        )
        parser.add_argument(
            "--publish_anyway",
            action="store_true",
            help="replace a better site, too",
        )
        parser.add_argument(
            "--no_webp", action="store_true", help="write the models' textures as PNG"
        )
        parser.add_argument("--allow_schemes", default="", help="of roots, as gs,s3")


def options(
    city: str,
    *,
    models: str = "",
    shard: str = "",
    schemes: Sequence[str] = (),
    beam: Sequence[str] = (),
) -> PipelineOptions:
    """Gather options, with the embedded runner for `DirectRunner` and for none.

    Raises:
        ValueError: if a word is no text or tells credentials, if the shard is not k/n
            with 1 <= k <= n, if a scheme is none, if there is no such runner, if nobody
            knows one of Beam's options, or for less than no workers.
    """
    part(shard)
    if secretive(city):
        raise ValueError(SECRETIVE)
    odd = next((one for one in (models, *beam) if not textual(one)), None)
    if odd is not None:
        shown = os.fsencode(odd).decode(errors="backslashreplace")
        raise ValueError(f"{shown}: is not UTF-8; write it anew, or rename the folder")
    told = (city, models, shard, ",".join(sorted(set(map(scheme, schemes)))))
    ours = dict(zip(OURS, told, strict=True))
    twice = [one for one in beam if one.partition("=")[0] in ours]
    if twice:
        raise ValueError(f"{twice[0]}: this command sets it, and Beam takes none")
    found = PipelineOptions([*(f"{name}={ours[name]}" for name in OURS), *beam])
    standard = found.view_as(StandardOptions)
    if standard.runner in ALIASES:
        standard.runner = EMBEDDED
    prism = found.view_as(PrismRunnerOptions)
    if "prism" in (standard.runner or "").casefold():
        prism.prism_location = cluster.prism(prism.prism_location)
    known(standard.runner or EMBEDDED, beam, prism.prism_location or "")
    if (standard.runner or EMBEDDED) != EMBEDDED:  # whose workers stand elsewhere
        own = found.view_as(CityOptions)
        own.city, own.models = map(anywhere, (own.city, own.models))
    workers = found.view_as(DirectOptions).direct_num_workers
    if workers < 0:
        raise ValueError(
            f"--direct_num_workers={workers}: give a count, or 0 for one on each core"
        )
    return found


def anywhere(path: str) -> str:
    """Name a folder of this machine as it is called from any other folder."""
    return str(Path(path).absolute()) if path and "://" not in path else path


def processes_here(options: PipelineOptions) -> int:
    """Tell how many processes of this machine are asked for."""
    told = options.view_as(DirectOptions).direct_num_workers
    return told or os.cpu_count() or 1


def known(runner: str, beam: Sequence[str], prism: str) -> None:
    """Insist on a runner that is there, and on options that somebody knows.

    Beam drops what it does not know without a word. Runners of clusters may know more
    options than Beam's own parser, so they are given all.

    Raises:
        ValueError: if there is no such runner or option, or a package lacks.
    """
    try:
        made = create_runner(runner)
    except (ImportError, AttributeError, TypeError, ValueError) as problem:
        raise ValueError(f"--runner {runner}: {problem}") from problem
    if not isinstance(made, PipelineRunner):  # Beam takes the path of any function
        raise ValueError(f"--runner {runner}: it is no runner")  # noqa: TRY004
    cluster.equipped(runner, prism)
    if runner != EMBEDDED:
        return
    parser: Any = argparse.ArgumentParser(
        add_help=False, allow_abbrev=False, conflict_handler="resolve"
    )
    for kind in PipelineOptions.__subclasses__():
        kind._add_argparse_args(parser)  # noqa: SLF001 - the hook that classes fill
    strangers = parser.parse_known_args(list(beam))[1]
    if strangers:
        raise ValueError(f"{strangers[0]}: neither nostalgin nor Beam knows it")


def scheme(written: str) -> str:
    """Read "GS" or "gs://" as gs.

    Raises:
        ValueError: if no URI begins so.
    """
    name = written.casefold().removesuffix("://")
    if not SCHEME.fullmatch(name):
        raise ValueError(f"--allow-scheme {written}: write it as gs, without a path")
    return name


def part(shard: str) -> tuple[int, int]:
    """Read "3/16" as the third of sixteen parts; an empty text is all in one part."""
    k, _, n = (shard or "1/1").partition("/")
    counts = k.isdecimal() and n.isdecimal() and max(len(k), len(n)) <= DIGITS
    if not (counts and 1 <= int(k) <= int(n)):
        raise ValueError(f"--shard {shard}: write it as 3/16, the third of 16 parts")
    return int(k), int(n)
