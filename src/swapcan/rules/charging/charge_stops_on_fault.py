"""The BMU ends charging on a fault of the charger."""

from __future__ import annotations

from functools import partial

from swapcan.messages import B2V_ST1, B2C_Charger, C2B_ACStatus, ChargeControl, ChargeState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="charge-stops-on-fault.seconds",
    value=3.0,
    unit="s",
    text=Text(
        "from the fault to the end of charging: six periods of the charger's messages",
        "从充电机故障到终止充电的时间:充电机报文的六个周期",
    ),
)

_FAULTS = ("charger_hardware", "charger_input_voltage", "charger_can")
"""The faults of the charger at which table 19 has the BMU end charging."""

_GOES_ON = Text(
    "charging goes on for {seconds:.2f} s under the charger's fault {fault}",
    "充电机报故障 {fault} 后,充电仍持续 {seconds:.2f} s",
)


class ChargeStopsOnFault(LastingWatcher):
    """Judges state and control of charging while the charger has a fault."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        seconds = findings.limit(_SECONDS)
        self._goes_on = {
            field: self.lasting(
                Subject("BMU", "B2V_ST1", "B2V_ST1_ChgSt", C2B_ACStatus.FIELDS[field].dbc_name),
                seconds,
                C2B_ACStatus,
            )
            for field in _FAULTS
        }

    def feed(self, chunk: Chunk) -> None:
        """Judge charging under each fault; what the BMU does not say in either message is not."""
        series = chunk.sound(C2B_ACStatus)
        state = LastKnown(chunk.sound(B2V_ST1), series)
        order = LastKnown(chunk.sound(B2C_Charger), series)
        ended = state.known & (state.raw("chg_st") != ChargeState.CHARGING)
        ended |= order.known & (order.raw("charge_control") != ChargeControl.START_TO_CHARGE)
        known = state.known | order.known
        for field, goes_on in self._goes_on.items():
            judged = known & (series.raw(field) == 1)
            goes_on.feed(series, judged, ~ended, partial(_describe, field))


def _describe(field: str, _: int) -> Said:
    return _GOES_ON, {"fault": C2B_ACStatus.FIELDS[field].dbc_name}


RULE = Rule(
    id="charge-stops-on-fault",
    title=Text("Charging ends on a charger's fault", "充电机故障时终止充电"),
    purpose=Text(
        "On faults of its hardware, its input voltage and its communication the BMU ends "
        "charging, and begins anew once they are gone.",
        "充电机硬件故障、输入电压异常或通讯故障时,BMU 终止充电流程,待故障消失后重启充电流程。",
    ),
    clause="Table 19 rows 3, 5 and 8 (5.4)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_SECONDS,),
    watch=ChargeStopsOnFault,
)
