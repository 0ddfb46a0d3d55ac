"""A pack that charges says that a charger is connected."""

from __future__ import annotations

from swapcan.messages import B2V_ST1, ChargeLine, ChargeState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SUBJECT = Subject("BMU", "B2V_ST1", "B2V_ST1_ChgLine")

_WITHOUT = Text(
    "Not connected for {seconds:.2f} s while the state is Charging",
    "充电状态下连接状态为未连接,持续 {seconds:.2f} s",
)


class ChargeLineConnected(LastingWatcher):
    """Compares two signals of a frame."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._without = self.lasting(_SUBJECT, None, B2V_ST1)

    def feed(self, chunk: Chunk) -> None:
        """Judge the connection while the pack charges."""
        states = chunk.sound(B2V_ST1)
        charging = states.raw("chg_st") == ChargeState.CHARGING
        apart = states.raw("chg_line") == ChargeLine.NOT_CONNECTED
        self._without.feed(states, charging, apart, _describe)


def _describe(_: int) -> Said:
    return _WITHOUT, {}


RULE = Rule(
    id="charge-line-connected",
    title=Text("Charging only while connected", "仅在充电连接状态下充电"),
    purpose=Text(
        "The VCU keeps the truck from driving away by the connection, not by the charging state.",
        "VCU 依据充电连接状态禁止车辆行驶,连接状态必须与充电状态相符。",
    ),
    clause="Table 1 rows 11 and 13 (5.1.1)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    watch=ChargeLineConnected,
)
