"""What `convert` does; apart from its arguments, since it imports what is an extra."""

from __future__ import annotations

import argparse
from dataclasses import replace

from typedcan.commands.log_options import size_of
from typedcan.commands.log_protocol import log_protocol
from typedcan.commands.tool import Tool, dbc_of
from typedcan.logs.convert import convert_logs
from typedcan.logs.part import window_of
from typedcan.logs.pipeline import Layout, Options
from typedcan.logs.plan import Mode
from typedcan.logs.progress import Progress
from typedcan.logs.raster import raster_step
from typedcan.logs.transfers.tables import TransferTables
from typedcan.shell.algorithms import algorithms_of
from typedcan.shell.console import note, say
from typedcan.shell.printing import printable_json

DAMAGED = 3
"""Exit status: a log is damaged; what comes before the damage was converted."""


def run(tool: Tool, given: argparse.Namespace) -> int:
    """Convert, print the summary, and return the exit status."""
    chosen = _options(given)
    protocol = log_protocol(tool, given)
    progress = Progress(sum(map(size_of, given.logs)))
    try:
        target, summary = convert_logs(
            given.logs,
            given.output,
            chosen,
            own=protocol,
            jobs=given.jobs,
            force=given.force,
            watch=progress.update,
        )
    finally:
        progress.clear()
    if given.json:
        say(printable_json({"output": str(target.path), **summary.as_json()}))
    for line in summary.lines():
        note(line)
    tables = f", tables: {len(summary.rows)}" if target.folder else ""
    note(f"wrote {target.path}{tables}")
    return DAMAGED if summary.damage else 0


def _options(given: argparse.Namespace) -> Options:
    options = Options(
        messages=tuple(given.messages),
        signals=tuple(given.signals),
        window=window_of(given.start, given.end, given.recorded_in),
        mode=Mode.RAW if given.raw else Mode.LABELS if given.labels else Mode.PHYSICAL,
        layout=Layout.LONG if given.long else Layout.MESSAGES,
        keep_faulty=given.keep_faulty,
        algorithms=algorithms_of(given),
    )
    if given.raster is not None:
        return replace(options, layout=Layout.RASTER, step=raster_step(given.raster))
    selected = dbc_of(given) or given.messages or given.signals
    if not selected and options.mode is Mode.PHYSICAL and options.layout is Layout.MESSAGES:
        # All there is of the own protocol: readings over several frames as columns too.
        return replace(options, derived=(TransferTables,))
    return options
