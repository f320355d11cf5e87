"""How the command line speaks: lines for people, or JSON for machines."""

import json
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from rich.console import Console

from pipelines.console.failure import fail, harmless, unheard

if TYPE_CHECKING:  # Beam is slow to load, and a voice is needed before it
    from pipelines.build import Report
    from pipelines.index import Indexed

MOST_LINES: Final = 30  # of rejections, to a reader; all are in the run's table


@dataclass
class Voice:
    """Tells people in lines, or machines in JSON, a line an event."""

    console: Console
    machine: bool = False
    lost: bool = False  # where it speaks, nobody listens any more

    def say(self, event: str, text: str, **facts: Any) -> None:
        """Tell one event; if nobody can hear it any more, the work goes on."""
        if self.lost:
            return
        try:
            if self.machine:
                print(json.dumps({"event": event, **facts}), flush=True)  # noqa: T201
            else:
                self.console.print(harmless(text), markup=False, highlight=False)
        except (OSError, SystemExit) as problem:  # the console exits on a closed pipe
            self.lost = True
            stream = sys.stdout if self.machine else self.console.file
            why = unheard(stream, problem)
            if self.machine:
                fail(f"standard output: {why}; the work goes on, but untold")


def summed(report: "Report", voice: Voice) -> None:
    """Tell what came of a build."""
    shown = report.rejections if voice.machine else report.grave(MOST_LINES)
    for one in shown:
        words = f"{one['key']}: {one['stage']}: {one['reason']}: {one['detail']}"
        voice.say("rejected", f"rejected {words}", **one)
    for reason, count in () if voice.machine else report.reasons():
        voice.say("reason", f"{count} times rejected by {reason}")
    if report.healed:
        words = f"{report.healed} damaged artifacts were made again"
        voice.say("healed", words, artifacts=report.healed)
    voice.say(
        "done",
        f"run {report.run}: {report.photos} photos, {report.rejected_photos} of them "
        f"gave nothing; {report.facades} facades; {report.blocks} blocks with "
        f"{report.buildings} buildings, {report.assumed} of them assumed; all "
        f"rejections are in runs/{report.run}/rejections.parquet",
        run=report.run,
        photos=report.photos,
        rejected_photos=report.rejected_photos,
        facades=report.facades,
        blocks=report.blocks,
        buildings=report.buildings,
        assumed=report.assumed,
        reasons=dict(report.reasons()),
    )


def indexed(made: "Indexed", city: str, voice: Voice) -> None:
    """Tell what came of an index."""
    for warning in made.warnings:
        voice.say("warning", f"warning: {warning}", warning=warning)
    for one in made.rejections:
        words = f"rejected {one.key}: {one.reason}: {one.detail}"
        voice.say("rejected", words, key=one.key, reason=one.reason, detail=one.detail)
    voice.say(
        "done",
        f"{made.photos} photos, {made.fronts} fronts in {made.blocks} blocks, "
        f"{made.without_photo} fronts without a photo: {city}/manifest.csv",
        photos=made.photos,
        fronts=made.fronts,
        blocks=made.blocks,
        fronts_without_photo=made.without_photo,
        photos_without_front=list(made.without_front),
    )
    if made.astray:
        count = len(made.without_front)
        words = f"{count} of {made.photos} photos found no place: is it their list?"
        voice.say("homeless", words, photos_without_front=count)
