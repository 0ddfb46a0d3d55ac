"""`listen`: the messages on a bus, as they arrive."""

from __future__ import annotations

import argparse
import math
from functools import partial

from typedcan.commands.bus_options import add_bus_options, bus_name, open_bus, told_once
from typedcan.commands.shown import add_filters, shown_of
from typedcan.commands.tool import Tool, add_protocol_options
from typedcan.commands.transcript import JSON_HELP, Transcript
from typedcan.drive.listening import listen
from typedcan.shell.command_line import Command
from typedcan.shell.console import OutputClosedError, count, note, seconds


def command(tool: Tool) -> Command:
    """The command of a command line."""
    return tool.command("listen", _add_arguments, partial(_run, tool))


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    add_protocol_options(parser)
    parser.add_argument("--json", action="store_true", help=JSON_HELP)
    parser.add_argument("--seconds", type=seconds, default=math.inf, help="end after so long")
    parser.add_argument("--count", type=count, default=math.inf, help="end after so many messages")
    add_filters(parser)
    add_bus_options(parser)


def _run(tool: Tool, options: argparse.Namespace) -> int:
    codec = tool.codec(options)
    shown = shown_of(options, codec)
    transcript = Transcript(codec, as_json=options.json, live=True, shown=shown)
    with open_bus(options) as bus:
        note(f"listening on {bus_name(bus, options)}, Ctrl-C ends")
        try:
            listen(
                bus,
                options.seconds,
                transcript.show,
                is_over=lambda: transcript.messages >= options.count,
                report=told_once(),
            )
        except OutputClosedError:
            raise
        except (KeyboardInterrupt, Exception):
            note(transcript.summary())
            raise
    note(transcript.summary())
    return 0
