"""The faults that a cooling unit tells of."""

from __future__ import annotations

from swapcan.messages import TMS_BMS_0
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SUBJECT = Subject("TMS", "TMS_BMS_0", "TMS_FaultLv")

_TOLD = Text(
    "fault level {level}, code {code}, for {seconds:.1f} s",
    "故障等级 {level} 级,故障码 {code},持续 {seconds:.1f} s",
)


class CoolingFaultTold(LastingWatcher):
    """Looks for a fault level or a fault code."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._told = self.lasting(_SUBJECT, None, TMS_BMS_0)

    def feed(self, chunk: Chunk) -> None:
        """Tell of the faults."""
        series = chunk.sound(TMS_BMS_0)
        level, code = series.raw("fault_lv"), series.raw("fault_code")

        def describe(row: int) -> Said:
            return _TOLD, {"level": int(level[row]), "code": int(code[row])}

        self._told.feed(series, None, (level > 0) | (code > 0), describe, level)


RULE = Rule(
    id="cooling-fault-told",
    title=Text("Faults of the cooling unit", "水冷机组故障"),
    purpose=Text(
        "The standard is kept where a cooling unit tells of a fault; the fault is worth knowing.",
        "水冷机组上报故障本身符合标准,但故障内容值得关注。",
    ),
    clause="Table 20 rows 6 and 7 (5.6)",
    severity=Severity.INFO,
    judges=("TMS",),
    watch=CoolingFaultTold,
)
