"""`swapcan listen`: the messages on a bus, as they arrive."""

from __future__ import annotations

import argparse
import math

from swapcan.commands import HELP
from swapcan.commands.bus_options import add_bus_options, bus_name, open_bus, told_once
from swapcan.commands.transcript import JSON_HELP, Transcript
from swapcan.drive.listening import listen
from typedcan.shell.command_line import Command
from typedcan.shell.console import OutputClosedError, count, note, seconds


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help=JSON_HELP)
    parser.add_argument("--seconds", type=seconds, default=math.inf, help="end after so long")
    parser.add_argument("--count", type=count, default=math.inf, help="end after so many messages")
    add_bus_options(parser)


def _run(options: argparse.Namespace) -> int:
    transcript = Transcript(as_json=options.json, live=True)
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


COMMAND = Command(
    name="listen",
    help=HELP["listen"],
    examples="""  swapcan listen -i socketcan -c can0
  swapcan listen -i pcan -c PCAN_USBBUS1 -b 250000 --json --seconds 10
  swapcan listen -i udp_multicast -c 239.74.163.2 --count 1""",
    add_arguments=_add_arguments,
    run=_run,
)
