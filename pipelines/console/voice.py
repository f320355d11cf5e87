"""How the command line speaks: lines for people, or JSON for machines."""

import json
import sys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from rich.console import Console

from pipelines import plural
from pipelines.console.alike import folded
from pipelines.console.failure import echo, fail, harmless, unheard

if TYPE_CHECKING:  # Beam is slow to load, and a voice is needed before it
    from pipelines.build import Report
    from pipelines.index import Indexed

MOST_LINES: Final = 30  # of rejections, to a reader; all are in the run's table
MOST_LETTERS: Final = 2000  # of a line to people, as ten thousand hide the others
GRAVE: Final = frozenset(("homeless", "held"))  # which the exit code tells, too


@dataclass
class Voice:
    """Tells people in lines, or machines in JSON, a line an event.

    A quiet one tells only what ends a command with another code than 0.
    """

    console: Console
    machine: bool = False
    quiet: bool = False
    lost: bool = False  # where it speaks, nobody listens any more

    def say(self, event: str, text: str, **facts: Any) -> None:
        """Tell one event; if nobody can hear it any more, the work goes on."""
        if self.lost or (self.quiet and event not in GRAVE):
            return
        try:
            if self.machine:
                print(json.dumps({"event": event, **facts}), flush=True)  # noqa: T201
            else:
                self.console.print(
                    harmless(shortened(text)), markup=False, highlight=False
                )
        except (OSError, SystemExit) as problem:  # the console exits on a closed pipe
            self.lost = True
            stream = sys.stdout if self.machine else self.console.file
            why = unheard(stream, problem)
            if self.machine:
                fail(f"standard output: {why}; the work goes on, but untold")

    def echo(self, text: str) -> None:
        """Tell on standard output what came of a command that has done its work.

        Raises:
            Exit: if nobody can read it there.
        """
        if not self.quiet:
            echo(text)


def shortened(text: str) -> str:
    """Leave out the middle of what is too long: names come first, remedies last."""
    if len(text) <= MOST_LETTERS:
        return text
    half = MOST_LETTERS // 2
    return f"{text[:half]} [...] {text[-half:]}"


def told_rejections(rejections: Iterable[Mapping[str, Any]], voice: Voice) -> None:
    """Tell why things were rejected: people are told alike ones in one line."""
    if voice.machine:
        for one in rejections:
            voice.say("rejected", "", **one)
        return
    lines = folded(rejections)
    for line in lines[:MOST_LINES]:
        voice.say("rejected", f"rejected {line}")
    if len(lines) > MOST_LINES:
        words = f"and for {len(lines) - MOST_LINES} other reasons; --json tells all"
        voice.say("rejected", words)


def summed(report: "Report", voice: Voice) -> None:
    """Tell what came of a build."""
    told_rejections(report.rejections if voice.machine else report.grave(), voice)
    for reason, count in () if voice.machine else report.reasons():
        times = plural.of(count, "time")
        voice.say("reason", f"{times} rejected by {reason}")
    if report.healed:
        words = f"{plural.of(report.healed, 'damaged artifact')} made again"
        voice.say("healed", words, artifacts=report.healed)
    table = f"runs/{report.run}/rejections.parquet"
    where = f"; `nostalgin report` shows all rejections, {table} has them"
    voice.say(
        "done",
        f"run {report.run}: {plural.of(report.photos, 'photo')}, "
        f"{report.rejected_photos} of them gave nothing; "
        f"{plural.of(report.facades, 'facade')}; {plural.of(report.blocks, 'block')} "
        f"with {plural.of(report.buildings, 'building')}, {report.assumed} of them "
        f"assumed; {report.widths_assumed} of {plural.of(report.fronts, 'width')} and "
        f"{report.heights_assumed} of {plural.of(report.buildings, 'height')} assumed"
        + where
        * report.tabled,
        run=report.run,
        photos=report.photos,
        rejected_photos=report.rejected_photos,
        facades=report.facades,
        blocks=report.blocks,
        buildings=report.buildings,
        assumed=report.assumed,
        fronts=report.fronts,
        widths_assumed=report.widths_assumed,
        heights_assumed=report.heights_assumed,
        reasons=dict(report.reasons()),
    )


def laid_out(made: "Indexed") -> str:
    """Count the photos, fronts and blocks of a manifest."""
    fronts, blocks = plural.of(made.fronts, "front"), plural.of(made.blocks, "block")
    return f"{plural.of(made.photos, 'photo')}, {fronts} in {blocks}"


def indexed(made: "Indexed", city: str, voice: Voice) -> None:
    """Tell what came of an index."""
    for warning in made.warnings:
        voice.say("warning", f"warning: {warning}", warning=warning)
    facts = ("key", "reason", "detail")
    named = [{name: getattr(r, name) for name in facts} for r in made.rejections]
    told_rejections(named, voice)
    if made.boards or len(made.witnesses) > 1:
        said = ", ".join(f"{count} {one}" for one, count in made.witnesses.items())
        boards = plural.of(made.boards, "board")
        words = f"by name, list and {boards}: {said}: {city}/readings.parquet"
        voice.say("witnesses", words, boards=made.boards, **made.witnesses)
    voice.say(
        "done",
        f"{laid_out(made)}, {plural.of(made.without_photo, 'front')} without a photo, "
        f"{plural.of(made.widths_assumed, 'width')} assumed: {city}/manifest.csv",
        photos=made.photos,
        fronts=made.fronts,
        blocks=made.blocks,
        fronts_without_photo=made.without_photo,
        widths_assumed=made.widths_assumed,
        photos_without_front=list(made.without_front),
    )
    if made.astray:
        count = len(made.without_front)
        photos = plural.of(made.photos, "photo")
        words = f"{count} of {photos} found no place: is it their list?"
        voice.say("homeless", words, photos_without_front=count)
