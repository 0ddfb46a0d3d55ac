"""The faults that a charger tells of."""

from __future__ import annotations

from functools import partial

from swapcan.messages import C2B_ACStatus
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_FAULTS = {
    "charger_hardware": Text("hardware fault", "硬件故障"),
    "charger_over_temp": Text("too hot", "温度过高"),
    "charger_input_voltage": Text("input voltage abnormal", "输入电压异常"),
    "charger_can": Text("communication fault", "通讯故障"),
}

_TOLD = Text("{fault}, for {seconds:.1f} s", "{fault},持续 {seconds:.1f} s")


class ChargerFaultTold(LastingWatcher):
    """Looks for fault bits."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._told = {
            field: self.lasting(
                Subject("CHG", "C2B_ACStatus", C2B_ACStatus.FIELDS[field].dbc_name),
                None,
                C2B_ACStatus,
            )
            for field in _FAULTS
        }

    def feed(self, chunk: Chunk) -> None:
        """Tell of the faults."""
        series = chunk.sound(C2B_ACStatus)
        for field, told in self._told.items():
            told.feed(series, None, series.raw(field) == 1, partial(_describe, field))


def _describe(field: str, _: int) -> Said:
    return _TOLD, {"fault": _FAULTS[field]}


RULE = Rule(
    id="charger-fault-told",
    title=Text("Faults of the charger", "充电机故障"),
    purpose=Text(
        "The standard is kept where a charger tells of a fault; the fault is worth knowing.",
        "充电机上报故障本身符合标准,但故障内容值得关注。",
    ),
    clause="Table 19 rows 3, 4, 5 and 8 (5.4)",
    severity=Severity.INFO,
    judges=("CHG",),
    watch=ChargerFaultTold,
)
