"""Single cells and probes do not say for long that they have no value."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_Temp, B2V_Ucell
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.logs.columns import State
from typedcan.logs.transfers.cycles import CycleTable
from typedcan.report.language import Text

SECONDS = Tolerance(
    name="reading-missing.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "How long a cell or probe may have no value",
        "单体或探针连续没有有效值的允许时间",
    ),
)

_MISSING = Text(
    "no value for {seconds:.1f} s, allowed are {limit:g} s",
    "{seconds:.1f} s 内没有有效值,允许 {limit:g} s",
)

_MESSAGES = {message.NAME: message for message in (B2V_Ucell, B2V_Temp)}

_Place = tuple[str, int, int]
"""Message, CSC, and number of the reading there."""


class ReadingMissing(Watcher):
    """Follows each reading of the complete cycles while it has no value."""

    wants_cycles = True

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._limit = findings.limit(SECONDS)
        self._open: dict[_Place, Occurrence] = {}

    def feed(self, chunk: Chunk) -> None:
        """Judge the cycles that are complete."""
        for table in chunk.cycles:
            self.findings.examine("BMU", len(table))
            message = table.readings.message
            missing = table.state != State.VALUE
            going_on = {place for place in self._open if place[0] == message}
            columns = set(np.flatnonzero(missing.any(axis=0)).tolist())
            for column, (csc, number) in enumerate(table.positions):
                place = message, csc, number
                if column in columns:
                    self._follow(chunk, table, place, missing[:, column])
                elif place in going_on:
                    self._close(place)

    def finish(self, end: LogEnd) -> None:  # noqa: ARG002
        """Judge what had no value until the end."""
        for place in list(self._open):
            self._close(place)

    def _follow(
        self, chunk: Chunk, table: CycleTable, place: _Place, missing: NDArray[np.bool_]
    ) -> None:
        """Go on with the run of before, and find those that begin."""
        steps = np.flatnonzero(np.diff(missing.astype(np.int8)))
        bounds = [0, *(steps + 1).tolist(), len(missing)]
        for begin, end in pairwise(bounds):
            if not missing[begin]:
                self._close(place)
                continue
            start, stop = (float(table.timestamp[row]) - chunk.begin for row in (begin, end - 1))
            run = self._open.get(place)
            series = chunk.frames(_MESSAGES[place[0]])
            row = max(0, int(np.searchsorted(series.time, start, "right")) - 1)
            self._open[place] = Occurrence(
                subject=Subject("BMU", place[0], detail=f"CSC {place[1]} number {place[2]}"),
                start=run.start if run else start,
                end=stop,
                order=run.order if run else int(series.order[row]),
                frames=(run.frames if run else 0) + end - begin,
                text=_MISSING,
            )

    def _close(self, place: _Place) -> None:
        """Judge a run that is over."""
        run = self._open.pop(place, None)
        if run is None or run.end - run.start <= self._limit:
            return
        seconds = run.end - run.start
        values = {"seconds": seconds, "limit": self._limit}
        self.findings.add(replace(run, measure=seconds, values=values))


RULE = Rule(
    id="reading-missing",
    title=Text("Cells and probes have a value", "单体和探针有有效值"),
    purpose=Text(
        "A cell or probe that is not measured is not watched either.",
        "没有测量值的单体或探针处于无监视状态。",
    ),
    clause="Table 9 rows 3 to 5 (5.1.8), Table 10 rows 3 to 8 (5.1.9)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(SECONDS,),
    watch=ReadingMissing,
)
