"""The warnings of the swap connector's temperature."""

from __future__ import annotations

from swapcan.messages import BSU_BMS_0
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SUBJECT = Subject("BSU", "BSU_BMS_0", "BSU_ConctorTempWarn")

_WARNED = Text(
    "swap connector too hot: level {level} at {degrees:.0f} degC, a warning for {seconds:.1f} s",
    "换电连接器对接口过温:{level} 级,{degrees:.0f} ℃,报警持续 {seconds:.1f} s",
)


class ConnectorWarningTold(LastingWatcher):
    """Looks for warnings."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._warned = self.lasting(_SUBJECT, None, BSU_BMS_0)

    def feed(self, chunk: Chunk) -> None:
        """Tell of the warnings."""
        series = chunk.sound(BSU_BMS_0)
        level, degrees = series.raw("conctor_temp_warn"), series.value("connector_temp")

        def describe(row: int) -> Said:
            return _WARNED, {"level": int(level[row]), "degrees": float(degrees[row])}

        self._warned.feed(series, None, level > 0, describe, level)


RULE = Rule(
    id="connector-warning-told",
    title=Text("The swap connector is too hot", "换电连接器过温报警"),
    purpose=Text(
        "A hot connector has a bad contact: it is to be looked after before it burns.",
        "连接器过温说明接触不良,应在烧蚀前检修。",
    ),
    clause="Table 17 row 5 (5.2.4)",
    severity=Severity.INFO,
    judges=("BSU",),
    watch=ConnectorWarningTold,
)
