"""The work of `plot`, which needs the extra ``logs``."""

from __future__ import annotations

import argparse
from pathlib import Path

from typedcan.commands.log_protocol import log_protocol
from typedcan.commands.tool import Tool
from typedcan.logs.part import window_of
from typedcan.logs.plot import Plot, PlotRequest, find_signals, read_plot, to_html, to_picture
from typedcan.logs.plot.html import notes
from typedcan.logs.progress import Progress
from typedcan.logs.protocol import Protocol
from typedcan.logs.transfers.readings import Readings
from typedcan.model.plain import shown
from typedcan.shell.algorithms import algorithms_of
from typedcan.shell.console import CommandError, note
from typedcan.shell.files import put_in_place

DAMAGED = 3
"""Exit status where the log is damaged."""

_MOST = 200
"""More signals at a time nobody can look at."""

_SUFFIXES = (".html", ".png")


def run(tool: Tool, options: argparse.Namespace) -> int:
    """Read the log, write the plot, say what there was to say; gives the exit status."""
    output: Path = options.output
    _check(output, force=options.force)
    request = _request(options, log_protocol(tool, options))
    progress = Progress(_size(options.log))
    try:
        plot = read_plot(options.log, request, progress.update)
    finally:
        progress.clear()
    status = DAMAGED if plot.damage is not None else 0
    for text in notes(plot):
        note(text)
    if not (plot.curves or plot.bands or plot.heats):
        note(f"{options.log}: there is nothing to draw")
        return status or 2
    _write(output, plot)
    counts = (
        (len(plot.curves) + len(plot.bands), "signals"),
        (len(plot.heats), "heat maps"),
    )
    drawn = ", ".join(f"{what} {count}" for count, what in counts if count)
    note(f"{output}: {drawn}, {plot.end - plot.start:,.1f} s")
    return status


def _request(options: argparse.Namespace, protocol: Protocol) -> PlotRequest:
    if not (options.signals or options.readings):
        known = "".join(f" or --readings {each.name}" for each in protocol.readings)
        raise CommandError(f"say what to draw: --signals NAME,...{known}")
    signals = find_signals(protocol, options.signals)
    if len(signals) > _MOST:
        raise CommandError(f"that is {len(signals)} signals; a plot has at most {_MOST}")
    return PlotRequest(
        protocol,
        signals,
        [_readings(protocol, name) for name in dict.fromkeys(options.readings)],
        window=window_of(options.start, options.end, options.recorded_in),
        algorithms=algorithms_of(options),
    )


def _readings(protocol: Protocol, name: str) -> Readings:
    for each in protocol.readings:
        if each.name == name:
            return each
    known = ", ".join(each.name for each in protocol.readings) or "none"
    raise CommandError(f"there are no readings {shown(name)}; known: {known}")


def _size(path: Path) -> int:
    """Bytes of the log; what is wrong with it is said where it is opened."""
    return path.stat().st_size if path.exists() else 0


def _check(output: Path, *, force: bool) -> None:
    if output.suffix.lower() not in _SUFFIXES:
        raise CommandError(f"{output}: the name must end in {' or '.join(_SUFFIXES)}")
    if output.is_dir():
        raise CommandError(f"{output}: there is a folder of that name")
    if output.exists() and not force:
        raise CommandError(f"{output}: exists; --force replaces it")


def _write(output: Path, plot: Plot) -> None:
    """The file appears complete or not at all."""
    is_page = output.suffix.lower() == ".html"
    content = to_html(plot).encode() if is_page else to_picture(plot)
    put_in_place({output: content})
