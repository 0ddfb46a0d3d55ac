"""`monitor`: a live bus in a terminal, or as lines where there is none."""

from __future__ import annotations

import argparse
import math
import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from types import FrameType

import can

from typedcan.commands.bus_options import add_bus_options, bus_name, open_bus
from typedcan.commands.monitor_lines import MonitorLines
from typedcan.commands.tool import Tool, add_protocol_options
from typedcan.model.errors import one_line
from typedcan.monitor.listener import Listener
from typedcan.monitor.session import Recorded, Session
from typedcan.monitor.watch import Watch
from typedcan.node.clock import SystemClock
from typedcan.shell.command_line import Command
from typedcan.shell.console import CommandError, count, note, seconds

_TICK = 0.05
"""Seconds between two looks at what happened."""

_SIGNALS = {"SIGTERM": 143, "SIGHUP": 129}
"""What ends the command as Ctrl-C does, with its exit status."""


def command(tool: Tool) -> Command:
    """The command of a command line."""
    return tool.command("monitor", _add_arguments, partial(_run, tool))


def _add_arguments(parser: argparse.ArgumentParser) -> None:
    add_protocol_options(parser)
    parser.add_argument(
        "--filter",
        default="",
        metavar="TEXT",
        help="only messages whose name, identifier, nodes or state have this text",
    )
    parser.add_argument(
        "--record",
        type=Path,
        metavar="FILE",
        help="record all frames, in the format of the suffix, such as drive.blf",
    )
    parser.add_argument(
        "--plain", action="store_true", help="print lines, as is done where there is no terminal"
    )
    parser.add_argument(
        "--json", action="store_true", help="print one JSON object a line, with all that is known"
    )
    parser.add_argument(
        "--interval", type=seconds, default=1.0, help="between two summaries (default: 1)"
    )
    parser.add_argument("--seconds", type=seconds, default=math.inf, help="end after so long")
    parser.add_argument("--count", type=count, default=math.inf, help="end after so many messages")
    add_bus_options(parser)


def _run(tool: Tool, options: argparse.Namespace) -> int:
    plain = options.plain or options.json or not _has_terminal()
    show = _show_lines if plain else _view(tool.program.split()[-1])
    codec = tool.codec(options)
    session: Session | None = None
    ended: Recorded | None = None
    try:
        with ExitStack() as stack:
            stack.enter_context(_ending_in_order())
            bus = stack.enter_context(open_bus(options))
            clock = SystemClock()
            glance = tool.glance(codec.protocol)
            watch = Watch(clock.now(), codec, glance=glance, bitrate=options.bitrate)
            session = Session(watch, clock)
            stack.callback(session.stop_recording)
            if options.record:
                session.record(options.record)
            listener = Listener(bus, session, reopen=lambda: _reopen(bus, options))
            with listener:
                is_over = _end(options, session, listener)
                status = show(options, session, bus_name(bus, options), is_over)
    finally:
        if session and (ended := session.status().ended):
            note(str(ended))
    return 2 if ended and ended.problem else status


def _end(options: argparse.Namespace, session: Session, listener: Listener) -> Callable[[], bool]:
    """What tells whether it is time to end."""
    deadline = time.monotonic() + options.seconds

    def is_over() -> bool:
        if time.monotonic() >= deadline or listener.has_ended:
            return True
        return options.count is not math.inf and session.status().messages >= options.count

    return is_over


Show = Callable[[argparse.Namespace, Session, str, Callable[[], bool]], int]
"""Shows a session on a named bus until it is over, and returns the exit status."""


def _view(program: str) -> Show:
    try:
        from typedcan.monitor.view import run_view
    except ModuleNotFoundError as error:
        if error.name and error.name.startswith("typedcan"):
            raise
        raise CommandError(
            "the view needs textual: pip install 'swapcan[monitor]'; --plain prints lines"
        ) from None
    return lambda options, session, bus, is_over: run_view(
        session, bus, name_filter=options.filter, record_name=program, is_over=is_over
    )


def _show_lines(
    options: argparse.Namespace, session: Session, bus: str, is_over: Callable[[], bool]
) -> int:
    lines = MonitorLines(session, as_json=options.json, name_filter=options.filter)
    note(f"monitoring {bus}, Ctrl-C ends")
    try:
        _print(lines, options.interval, is_over)
    except (KeyboardInterrupt, SystemExit):
        lines.end()
        raise
    lines.end()
    return 0


def _print(lines: MonitorLines, interval: float, is_over: Callable[[], bool]) -> None:
    due = time.monotonic() + interval
    while not is_over():
        time.sleep(min(max(due - time.monotonic(), 0), _TICK))
        lines.events()
        if time.monotonic() >= due:
            lines.summary()
            due += interval


def _has_terminal() -> bool:
    streams = (sys.stdin, sys.stdout)
    return all(each and each.isatty() for each in streams) and os.environ.get("TERM") != "dumb"


def _reopen(lost: can.BusABC, options: argparse.Namespace) -> can.BusABC:
    """Open the bus anew; raises `can.CanError`."""
    with suppress(Exception):
        lost.shutdown()  # most adapters can be open only once
    try:
        return open_bus(options)
    except CommandError as error:
        raise can.CanInitializationError(one_line(error)) from None


@contextmanager
def _ending_in_order() -> Iterator[None]:
    """Let other signals end the command as Ctrl-C does: a recording is to be closed."""
    numbers = {getattr(signal, name, None): status for name, status in _SIGNALS.items()}

    def leave(number: int, _frame: FrameType | None) -> None:
        raise SystemExit(numbers[number])

    # One that is ignored stays ignored, as with nohup.
    taken = [each for each in numbers if each and signal.getsignal(each) is not signal.SIG_IGN]
    before = {number: signal.signal(number, leave) for number in taken}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
