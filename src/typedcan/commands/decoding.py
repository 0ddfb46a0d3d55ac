"""What `decode` does; apart from its arguments, since it imports what is an extra."""

from __future__ import annotations

import argparse
import time
from itertools import islice

from typedcan.commands.shown import shown_of
from typedcan.commands.tool import Tool
from typedcan.commands.transcript import Transcript
from typedcan.logs.part import LogPart, Window, window_of
from typedcan.logs.replayed import frames_of
from typedcan.shell.console import CommandError, note

_BLOCK = 1 << 12
"""Frames in a block: few, so that the first lines come at once."""

_POLL = 0.25
"""Seconds between two looks at a log that grows; it is read again, so at least twice what that
takes."""


def run(tool: Tool, options: argparse.Namespace) -> int:
    """Print the messages of a log and a summary, and return the exit status."""
    codec = tool.codec(options)
    shown = shown_of(options, codec)
    transcript = Transcript(codec, as_json=options.json, live=options.follow, shown=shown)
    window = window_of(options.start, options.end, options.recorded_in)
    if options.follow:
        try:
            _follow(options, window, transcript)
        except KeyboardInterrupt:
            note(transcript.summary())
            return 0
    log = _decode(options, window, transcript)
    log.check_found()
    if passed := log.passed:
        counts = ", ".join(f"{what} {many:,}" for what, many in passed.most_common())
        note(f"no frames on the bus: {counts}")
    if log.damage is not None:
        raise CommandError(f"{log.damage}; read: {transcript.summary()}")
    note(transcript.summary())
    return 0


def _decode(options: argparse.Namespace, window: Window, transcript: Transcript) -> LogPart:
    with LogPart(options.file, _BLOCK, window) as log:
        for frame in frames_of(log):
            transcript.show(frame)
        return log


def _follow(options: argparse.Namespace, window: Window, transcript: Transcript) -> None:
    """Show what is there and what comes, until Ctrl-C."""
    size, seen = -1, 0
    while True:
        begun = time.monotonic()
        now = options.file.stat().st_size if options.file.exists() else 0
        if now < size:
            note(f"{options.file}: begins anew")
            seen = 0
        if now != size or size < 0:
            size = now
            with LogPart(options.file, _BLOCK, window) as log:
                for frame in islice(frames_of(log), seen, None):
                    transcript.show(frame)
                    seen += 1
        time.sleep(max(_POLL, 2 * (time.monotonic() - begun)))
