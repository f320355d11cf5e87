"""What a build is told, as Beam options, so that any runner's launcher can tell it."""

import argparse
from collections.abc import Sequence
from typing import Final

from apache_beam.options.pipeline_options import (
    DirectOptions,
    PipelineOptions,
    StandardOptions,
)

EMBEDDED: Final = "FnApiRunner"  # Beam's own runner in this process
# What people call it; Beam itself would fetch another runner for these names.
ALIASES: Final = ("DirectRunner", "BundleBasedDirectRunner", "", None)


class CityOptions(PipelineOptions):
    """The city folder, and which part of it to build."""

    @classmethod
    def _add_argparse_args(cls, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("--city", help="the city folder")
        parser.add_argument("--models", default="", help="folder of other networks")
        parser.add_argument("--shard", default="", help="part of the blocks, as 3/16")


def options(
    city: str, *, models: str = "", shard: str = "", beam: Sequence[str] = ()
) -> PipelineOptions:
    """Gather options, with the embedded runner for `DirectRunner` and for none.

    More than one worker means processes, not threads: the time between calls of ONNX
    Runtime, OpenCV and NumPy is Python's own.

    Raises:
        ValueError: if the shard is not k/n with 1 <= k <= n.
    """
    part(shard)
    ours = [f"--city={city}", f"--models={models}", f"--shard={shard}"]
    found = PipelineOptions([*ours, *beam])
    if found.view_as(StandardOptions).runner in ALIASES:
        found.view_as(StandardOptions).runner = EMBEDDED
    direct = found.view_as(DirectOptions)
    several = (direct.direct_num_workers or 1) != 1
    named = any(one.startswith("--direct_running_mode") for one in beam)
    if several and not named:
        direct.direct_running_mode = "multi_processing"
    return found


def part(shard: str) -> tuple[int, int]:
    """Read "3/16" as the third of sixteen parts; an empty text is all in one part."""
    k, _, n = (shard or "1/1").partition("/")
    if not (k.isdecimal() and n.isdecimal() and 1 <= int(k) <= int(n)):
        raise ValueError(f"--shard {shard}: write it as 3/16, the third of 16 parts")
    return int(k), int(n)
