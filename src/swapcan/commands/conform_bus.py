"""Judging what is on a bus: it is recorded, heard or driven, and the record is judged."""

from __future__ import annotations

import argparse
import re
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path

import can

from swapcan.commands.conform_choice import Choice
from swapcan.commands.conform_reports import Judged
from swapcan.commands.driving import HUNG, LIVE
from swapcan.scenarios.announcement import announcement
from swapcan.scenarios.scenario import Scenario
from swapcan.scenarios.scenarios import scenarios_of
from swapcan.scenarios.stage import LEAVING, Left, Stage
from typedcan.commands.bus_options import bus_name, open_bus, told_once
from typedcan.drive.listening import listen
from typedcan.shell.console import CommandError, note, warn
from typedcan.shell.process_signals import Interrupts
from typedcan.shell.progress import StatusLine
from typedcan.shell.recording import Recording

_DURATION = 60.0
"""Seconds to listen where nothing else is said."""

_LEFT = {
    Left.SAFE: "the pack has reported that it is off",
    Left.UNKNOWN: "the pack has not reported that it is off",
}


def judged_on_bus(given: argparse.Namespace, choice: Choice, stack: ExitStack) -> list[Judged]:
    """Record a bus and judge the record; nothing where scenarios were announced only.

    Parameters
    ----------
    stack
        Where it ends, records that are not to be kept are gone.
    """
    if not given.active:
        choice.check()
        return [_heard(given, choice, stack)]
    scenarios = [(each, each.played(given.play)) for each in scenarios_of(given.active)]
    for scenario, nodes in scenarios:
        choice.check(scenario.rules)
        for node in set(nodes) & set(choice.nodes):
            raise CommandError(f"{scenario.name} plays {node}: it cannot be judged beside that")
    for scenario, nodes in scenarios:
        for line in announcement(scenario, nodes):
            note(line)
    if not given.yes_drive_the_bus:
        note("nothing was sent; --yes-drive-the-bus sends it")
        return []
    return _driven(given, choice, scenarios, stack)


def _heard(given: argparse.Namespace, choice: Choice, stack: ExitStack) -> Judged:
    path = given.record or _folder(stack) / "heard.log"
    seconds = given.duration or _DURATION
    with open_bus(given) as bus, Interrupts() as interrupts:
        name = _record_name(given, bus)
        with _recorded(path) as recording:
            note(f"listening on {name} for {seconds:g} s, Ctrl-C ends it early")
            progress = StatusLine()
            try:
                listen(
                    bus,
                    seconds,
                    _noting(recording, given.channel),
                    is_over=lambda: interrupts.is_over,
                    watch=partial(_draw, progress, recording),
                    report=told_once(),
                )
            finally:
                progress.clear()
    interrupts.stop_if_asked()
    interrupts.go_on()
    return _judged(given, choice, path, name)


def _driven(
    given: argparse.Namespace,
    choice: Choice,
    scenarios: list[tuple[Scenario, tuple[str, ...]]],
    stack: ExitStack,
) -> list[Judged]:
    paths = [_record_of(given, scenario, len(scenarios), stack) for scenario, _ in scenarios]
    for path in paths:
        if path.exists():  # better now than after the first of them
            raise CommandError(f"{path}: is there already, choose another name")
    played = 0
    left = Left.UNTOUCHED
    with open_bus(given) as bus, Interrupts() as interrupts:
        name = _record_name(given, bus)
        stage = Stage(bus, is_over=lambda: interrupts.is_over, warn=lambda: warn(HUNG))
        interrupts.at_once, interrupts.hangs = stage.send_safe_codes, lambda: stage.hangs
        for (scenario, nodes), path in zip(scenarios, paths, strict=True):
            if interrupts.is_over or left is Left.UNKNOWN:
                break
            note(f"playing {scenario.name} on {name}, Ctrl-C switches off and ends")
            with _recorded(path) as recording:
                left = _play(stage, scenario, nodes, recording, given.channel)
            interrupts.stop_if_asked()  # nothing acts any more
            played += 1
    interrupts.go_on()
    judged = [
        _judged(given, choice, path, name, scenario)
        for (scenario, _), path in zip(scenarios[:played], paths, strict=False)
    ]
    cut = _LEFT[left] if left is Left.UNKNOWN else ""
    cut = "it was ended early" if interrupts.is_over else cut
    if cut and judged:
        rest = ", ".join(scenario.name for scenario, _ in scenarios[played:])
        judged[-1] = replace(judged[-1], cut=f"{cut}; not played: {rest}" if rest else cut)
    return judged


def _play(
    stage: Stage,
    scenario: Scenario,
    nodes: tuple[str, ...],
    recording: Recording,
    channel: str | None,
) -> Left:
    progress = StatusLine()
    stage.watch = partial(_draw, progress, recording)
    try:
        stage.play(scenario, nodes, _noting(recording, channel))
    finally:
        progress.clear()
        if stage.left is Left.UNKNOWN:
            note(f"{scenario.name}: {_LEFT[stage.left]} within {LEAVING:g} s: {LIVE}")
        elif stage.left is Left.SAFE:
            note(f"{scenario.name}: {_LEFT[stage.left]}")
    return stage.left


def _judged(
    given: argparse.Namespace,
    choice: Choice,
    path: Path,
    name: str,
    scenario: Scenario | None = None,
) -> Judged:
    rules = scenario.rules if scenario else ()
    judgement = choice.judge(path, rules)
    if given.record is None:
        log = f"{name}: {scenario.name}" if scenario else name
        judgement = replace(judgement, log=log)
    return Judged(judgement, path, tuple(rule.id for rule in rules))


def _record_of(given: argparse.Namespace, scenario: Scenario, count: int, stack: ExitStack) -> Path:
    record: Path | None = given.record
    if record is None:
        return _folder(stack) / f"{scenario.name}.log"
    return record if count == 1 else record.with_stem(f"{record.stem}-{scenario.name}")


def _folder(stack: ExitStack) -> Path:
    return Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="swapcan-")))


def _record_name(given: argparse.Namespace, bus: can.BusABC) -> str:
    """Interface and channel, as far as they are known."""
    named = " ".join(filter(None, (given.interface, given.channel)))
    return named or bus_name(bus, given)


def _noting(recording: Recording, channel: str | None) -> Callable[[can.Message], None]:
    """What writes a frame, with the channel's name where the interface gives it none."""
    # In a log of candump a name ends at the first space.
    name = channel if channel and not re.search(r"\s", channel) else None

    def note_frame(frame: can.Message) -> None:
        if frame.channel is None:
            frame.channel = name
        recording.write(frame)

    return note_frame


@contextmanager
def _recorded(path: Path) -> Iterator[Recording]:
    """A record that is closed in the end, and kept whatever happens."""
    recording = Recording(path)
    try:
        yield recording
    finally:
        recording.close()


def _draw(progress: StatusLine, recording: Recording, passed: float, seconds: float) -> None:
    """Show the time left and the frames so far."""
    left = max(0.0, seconds - passed)
    progress.draw(lambda: f"{left:.0f} s left, frames: {recording.frames:,}")
