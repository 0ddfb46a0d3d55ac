"""The charger stops when it is told to."""

from __future__ import annotations

from swapcan.messages import B2C_Charger, C2B_ACStatus, ChargeControl
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_CURRENT = Tolerance(
    name="charger-stops.current",
    value=2.0,
    unit="A",
    text=Text("what still counts as no current", "仍视为无电流的值"),
)
_SECONDS = Tolerance(
    name="charger-stops.seconds",
    value=3.0,
    unit="s",
    text=Text(
        "from the stop to no current: six periods of its messages, and its ramp down",
        "从停止指令到无电流的时间:报文的六个周期,含电流下降过程",
    ),
)

_SUBJECT = Subject("CHG", "C2B_ACStatus", "C2B_N_CurrentOutput")

_GIVES = Text(
    "up to {current:.1f} A for {seconds:.2f} s while the BMU says to stop",
    "BMU 要求停止充电后仍输出电流,持续 {seconds:.2f} s,最大 {current:.1f} A",
)


class ChargerStops(LastingWatcher):
    """Judges the charger's current while it is told to stop."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._current = findings.limit(_CURRENT)
        self._gives = self.lasting(_SUBJECT, findings.limit(_SECONDS), C2B_ACStatus)

    def feed(self, chunk: Chunk) -> None:
        """Judge the current under a stop."""
        series = chunk.sound(C2B_ACStatus)
        order = LastKnown(chunk.sound(B2C_Charger), series)
        judged = order.is_code("charge_control", ChargeControl.NORMAL_STOP_TO_CHARGE)
        judged |= order.is_code("charge_control", ChargeControl.FAULT_STOP_TO_CHARGE)
        current = series.value("current_output")

        def describe(row: int) -> Said:
            return _GIVES, {"current": float(current[row])}

        self._gives.feed(series, judged, current >= self._current, describe, current)


RULE = Rule(
    id="charger-stops",
    title=Text("The charger stops when told to", "充电机按指令停止"),
    purpose=Text(
        "The BMU opens its relays after the stop: current that still flows burns them.",
        "BMU 发出停止指令后将断开继电器,此时仍有电流会烧蚀触点。",
    ),
    clause="Table 18 row 3 (5.3)",
    severity=Severity.MUST,
    judges=("CHG",),
    tolerances=(_CURRENT, _SECONDS),
    watch=ChargerStops,
)
