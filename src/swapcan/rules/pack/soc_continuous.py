"""The state of charge does not jump."""

from __future__ import annotations

import numpy as np

from swapcan.messages import B2V_ST1, B2V_ST2
from swapcan.rules.pack.runs import ROUNDING
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_STEP = Tolerance(
    name="soc-continuous.percent",
    value=2.0,
    unit="%",
    text=Text(
        "how far SOC may go from one frame to the next, five of its steps",
        "相邻两帧 SOC 的允许变化量,即五个步长",
    ),
)
_PAUSE = Tolerance(
    name="soc-continuous.seconds",
    value=1.0,
    unit="s",
    text=Text(
        "frames that are further apart are not compared",
        "间隔更长的帧不作比较",
    ),
)
_TOLD = Tolerance(
    name="soc-continuous.told",
    value=0.25,
    unit="s",
    text=Text(
        "how long before or after a jump its alarm may come, as another frame tells it",
        "跳变报警可早于或晚于跳变的时间,因由另一报文上报",
    ),
)

_JUMP = Text(
    "SOC goes from {before:.1f} % to {now:.1f} % within {step:.2g} s, without its alarm; allowed: "
    "{allowed:g} %",
    "SOC 在 {step:.2g} s 内由 {before:.1f} % 变为 {now:.1f} %,且无跳变报警;允许 {allowed:g} %",
)

_SIGNAL = B2V_ST2.FIELDS["soc"].dbc_name


class SocContinuous(Watcher):
    """Looks for jumps that the alarm for them (table 12 row 16) does not tell."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._allowed, self._pause = findings.limit(_STEP), findings.limit(_PAUSE)
        self._told = findings.limit(_TOLD)
        self._jumps: list[Occurrence] = []
        self._alarms: list[float] = []

    def feed(self, chunk: Chunk) -> None:
        """Judge the new frames."""
        status = chunk.sound(B2V_ST1)
        raised = np.flatnonzero(status.new_raw("flt_soc_jump")) + status.first
        self._alarms += status.time[raised].tolist()
        self._find(chunk)
        self._report(chunk.end)

    def finish(self, end: LogEnd) -> None:
        """Report the last ones."""
        del end
        self._report(np.inf)

    def _find(self, chunk: Chunk) -> None:
        series = chunk.sound(B2V_ST2)
        if len(series) < 2:
            return
        soc, steps = series.value("soc"), np.diff(series.time)
        change = np.abs(np.diff(soc))
        compared = (steps >= 0) & (steps <= self._pause + ROUNDING) & ~np.isnan(change)
        self.findings.examine(B2V_ST2.SENDER, int(np.count_nonzero(compared)))
        for row in np.flatnonzero(compared & (change > self._allowed + ROUNDING)).tolist():
            found = Occurrence(
                subject=Subject(B2V_ST2.SENDER, B2V_ST2.NAME, _SIGNAL),
                start=float(series.time[row + 1]),
                end=float(series.time[row + 1]),
                order=int(series.order[row + 1]),
                measure=float(change[row]),
                text=_JUMP,
                values={
                    "before": float(soc[row]),
                    "now": float(soc[row + 1]),
                    "step": float(steps[row]),
                    "allowed": self._allowed,
                },
            )
            self._jumps.append(found)

    def _report(self, now: float) -> None:
        """Report the jumps whose alarm would have come by now."""
        latest = now - self._told - ROUNDING
        alarms = np.array(self._alarms)
        for jump in self._jumps:
            if jump.start < latest and not (np.abs(alarms - jump.start) <= self._told).any():
                self.findings.add(jump)
        self._jumps = [jump for jump in self._jumps if jump.start >= latest]
        self._alarms = alarms[alarms >= latest - self._told].tolist()


RULE = Rule(
    id="soc-continuous",
    title=Text("SOC does not jump without its alarm", "SOC 无未报警的跳变"),
    purpose=Text(
        "The range that is left is estimated by SOC; a jump is to be told by its alarm.",
        "VCU 以 SOC 估算可续驶里程;发生跳变时应上报 SOC 跳变报警。",
    ),
    clause="Table 1 row 1 (5.1.1), Table 12 row 16 (5.1.11)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_STEP, _PAUSE, _TOLD),
    watch=SocContinuous,
)
