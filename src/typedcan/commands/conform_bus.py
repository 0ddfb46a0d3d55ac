"""Judging what is on a bus: it is recorded, and the record is judged."""

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

from typedcan.commands.bus_options import bus_name, open_bus, told_once
from typedcan.commands.conform_choice import Choice
from typedcan.commands.conform_reports import Judged
from typedcan.drive.listening import listen
from typedcan.shell.console import note
from typedcan.shell.process_signals import Interrupts
from typedcan.shell.progress import StatusLine
from typedcan.shell.recording import Recording

_DURATION = 60.0
"""Seconds to listen where nothing else is said."""


def judged_by_hearing(given: argparse.Namespace, choice: Choice, stack: ExitStack) -> list[Judged]:
    """Record a bus and judge the record.

    Parameters
    ----------
    stack
        Where it ends, a record that is not to be kept is gone.
    """
    choice.check()
    path = given.record or folder(stack) / "heard.log"
    seconds = given.duration or _DURATION
    with open_bus(given) as bus, Interrupts() as interrupts:
        name = record_name(given, bus)
        with recorded(path) as recording:
            note(f"listening on {name} for {seconds:g} s, Ctrl-C ends it early")
            progress = StatusLine()
            try:
                listen(
                    bus,
                    seconds,
                    noting(recording, given.channel),
                    is_over=lambda: interrupts.is_over,
                    watch=partial(draw, progress, recording),
                    report=told_once(),
                )
            finally:
                progress.clear()
    interrupts.stop_if_asked()
    interrupts.go_on()
    judgement = choice.judge(path)
    if given.record is None:
        judgement = replace(judgement, log=name)
    return [Judged(judgement, path)]


def folder(stack: ExitStack) -> Path:
    """A folder that is gone where the stack ends."""
    return Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="conform-")))


def record_name(given: argparse.Namespace, bus: can.BusABC) -> str:
    """Interface and channel, as far as they are known."""
    named = " ".join(filter(None, (given.interface, given.channel)))
    return named or bus_name(bus, given)


def noting(recording: Recording, channel: str | None) -> Callable[[can.Message], None]:
    """What writes a frame, with the channel's name where the interface gives it none."""
    # In a log of candump a name ends at the first space.
    name = channel if channel and not re.search(r"\s", channel) else None

    def note_frame(frame: can.Message) -> None:
        if frame.channel is None:
            frame.channel = name
        recording.write(frame)

    return note_frame


@contextmanager
def recorded(path: Path) -> Iterator[Recording]:
    """A record that is closed in the end, and kept whatever happens."""
    recording = Recording(path)
    try:
        yield recording
    finally:
        recording.close()
        for remark in recording.remarks():
            note(remark)


def draw(progress: StatusLine, recording: Recording, passed: float, seconds: float) -> None:
    """Show the time left and the frames so far."""
    left = max(0.0, seconds - passed)
    progress.draw(lambda: f"{left:.0f} s left, frames: {recording.frames:,}")
