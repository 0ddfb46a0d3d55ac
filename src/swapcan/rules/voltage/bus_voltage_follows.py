"""With the main relays closed both of their sides have the same voltage."""

from __future__ import annotations

import numpy as np

from swapcan.messages import B2V_ST1, B2V_ST3, BmsState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SHARE = Tolerance(
    name="bus-voltage-follows.share",
    value=0.05,
    text=Text(
        "difference of the two voltages as a share of the battery's, for what the sensors differ",
        "两侧电压之差占电池端电压的比例,考虑传感器误差",
    ),
)
_SECONDS = Tolerance(
    name="bus-voltage-follows.seconds",
    value=0.5,
    unit="s",
    text=Text(
        "for which they may differ by more, as after a change of state",
        "允许超出该比例的时间,如状态刚改变之后",
    ),
)

_SUBJECT = Subject("BMU", "B2V_ST3", "B2V_ST3_Upack_Out")

_DIFFERS = Text(
    "{out:.1f} V on the bus bar, {battery:.1f} V at the battery, allowed {allowed:.1f} V "
    "between them, for {seconds:.2f} s while the state is HV closed",
    "状态为 HV closed 时,母线端 {out:.1f} V,电池端 {battery:.1f} V,允许相差 {allowed:.1f} V,"
    "持续 {seconds:.2f} s",
)


class BusVoltageFollows(LastingWatcher):
    """Compares the voltages of B2V_ST3."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._share = findings.limit(_SHARE)
        self._differs = self.lasting(_SUBJECT, findings.limit(_SECONDS), B2V_ST3)

    def feed(self, chunk: Chunk) -> None:
        """Judge the voltages under the state HV closed."""
        voltages = chunk.sound(B2V_ST3)
        state = LastKnown(chunk.sound(B2V_ST1), voltages)
        battery, out = voltages.value("upack_batt"), voltages.value("upack_out")
        allowed = battery * self._share
        excess = np.abs(out - battery) - allowed
        judged = state.is_code("bms", BmsState.HV_CLOSED) & ~np.isnan(excess)

        def describe(row: int) -> Said:
            return _DIFFERS, {
                "out": float(out[row]),
                "battery": float(battery[row]),
                "allowed": float(allowed[row]),
            }

        self._differs.feed(voltages, judged, excess > 0, describe, excess)


RULE = Rule(
    id="bus-voltage-follows",
    title=Text("The bus bar has the battery's voltage", "母线端电压与电池端电压一致"),
    purpose=Text(
        "Closed relays have the same voltage on both sides; another one means a bad contact or "
        "a wrong measurement.",
        "继电器闭合后两侧电压应相同,否则说明接触不良或测量有误。",
    ),
    clause="Table 1 rows 4 and 5 (5.1.1)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_SHARE, _SECONDS),
    watch=BusVoltageFollows,
)
