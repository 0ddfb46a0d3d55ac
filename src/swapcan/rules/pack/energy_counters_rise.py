"""The energy counters never fall."""

from __future__ import annotations

from functools import partial

import numpy as np

from swapcan.messages import B2V_ElecEnergy
from swapcan.rules.pack.integral import Numbers
from swapcan.rules.pack.runs import ROUNDING, Runs
from swapcan.rules.pack.silences import Silences
from swapcan.rules.shared import ANOTHER_PACK
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, LeftOpen, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_FALL = Tolerance(
    name="energy-counters-rise.fall",
    value=0.1,
    unit="kWh",
    text=Text("how far a counter may fall, one step", "计数允许下降量,即一个步长"),
)
_ANEW = Tolerance(
    name="energy-counters-rise.anew",
    value=1.0,
    unit="kWh",
    text=Text(
        "from how much the energy of one charge may begin anew: 360 kW charge it within the 10 s "
        "between two frames",
        "单次充电电量重新开始时的最大值:以 360 kW 充电,两帧间隔 10 s 内即可达到",
    ),
)

_COUNTERS = ("tot_chg_energy", "tot_dischg_energy", "single_chg_energy")
_SINGLE = "single_chg_energy"

_FELL = Text(
    "falls from {before:.1f} kWh to {now:.1f} kWh; allowed: {allowed:g} kWh",
    "由 {before:.1f} kWh 降至 {now:.1f} kWh;允许下降 {allowed:g} kWh",
)


class EnergyCountersRise(Watcher):
    """Compares each counter with that of the frame before, unless it may be of another pack."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._fall, self._anew = findings.limit(_FALL), findings.limit(_ANEW)
        self._silences = Silences(findings)
        node, name, fields = B2V_ElecEnergy.SENDER, B2V_ElecEnergy.NAME, B2V_ElecEnergy.FIELDS
        self._runs = {
            field: Runs(findings, Subject(node, name, fields[field].dbc_name))
            for field in _COUNTERS
        }

    def feed(self, chunk: Chunk) -> None:
        """Judge the new frames."""
        self._silences.feed(chunk)
        series = chunk.sound(B2V_ElecEnergy)
        if len(series) < 2 or not series.fresh:
            return
        same_pack = np.diff(self._silences.up_to(series.order)) == 0
        time, order = series.time[1:][same_pack], series.order[1:][same_pack]
        for field, runs in self._runs.items():
            value = series.value(field)
            before, now = value[:-1][same_pack], value[1:][same_pack]
            fall = before - now
            wrong = fall > self._fall + ROUNDING
            if field == _SINGLE:
                wrong &= now > self._anew + ROUNDING
            runs.feed(time, order, wrong, partial(self._describe, before, now), fall)

    def finish(self, end: LogEnd) -> None:
        """Report what lasts to the end."""
        del end
        for runs in self._runs.values():
            runs.finish()

    def _describe(self, before: Numbers, now: Numbers, row: int) -> Said:
        said = {"before": float(before[row]), "now": float(now[row]), "allowed": self._fall}
        return _FELL, said


RULE = Rule(
    id="energy-counters-rise",
    title=Text("Energy counters never fall", "累计充放电电量不下降"),
    purpose=Text(
        "What a swap costs, and what a pack has lived through, is read from them.",
        "换电计费及电池寿命评估以累计充放电电量为依据。",
    ),
    clause="Table 4 (5.1.4)",
    severity=Severity.MUST,
    left_open=(LeftOpen("B2V_SingleChgEnergy", ("E62",)),),
    judges=("BMU",),
    tolerances=(_FALL, _ANEW, ANOTHER_PACK),
    watch=EnergyCountersRise,
)
