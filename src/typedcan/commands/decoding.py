"""What `decode` does; apart from its arguments, since it imports what is an extra."""

from __future__ import annotations

import argparse

from typedcan.commands.tool import Tool
from typedcan.commands.transcript import Transcript
from typedcan.logs.part import LogPart, TimeError, window_of
from typedcan.logs.replayed import frames_of
from typedcan.shell.console import note

DAMAGED = 3
"""Exit status: the log is damaged; what can be read of it was decoded."""

_BLOCK = 1 << 12
"""Frames in a block: few, so that the first lines come at once."""


def run(tool: Tool, options: argparse.Namespace) -> int:
    """Print the messages of a log and a summary, and return the exit status."""
    transcript = Transcript(tool.codec(options), as_json=options.json)
    window = window_of(options.start, options.end, options.recorded_in)
    with LogPart(options.file, _BLOCK, window) as log:
        empty = True
        for frame in frames_of(log):
            empty = False
            transcript.show(frame)
        if empty and not window.is_open and log.damage is None and log.spans():
            raise TimeError(f"{log.path}: no frame in this part; the log goes from {log.spans()}")
        if log.clock.text:
            note(f"began {log.clock.text}")
        if passed := log.source.passed:
            counts = ", ".join(f"{what} {many:,}" for what, many in passed.most_common())
            note(f"no frames on the bus: {counts}")
        if log.damage is not None:
            note(str(log.damage))
    note(transcript.summary())
    return DAMAGED if log.damage is not None else 0
