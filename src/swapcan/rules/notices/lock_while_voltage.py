"""High voltage only while the pack is locked and connected."""

from __future__ import annotations

from functools import partial

from swapcan.messages import B2V_ST1, BSU_BMS_0, BmsState, ConnectorState, LockState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="lock-while-voltage.seconds",
    value=0.5,
    unit="s",
    text=Text(
        "for which lock and voltage may disagree, as their messages are not sent at one moment",
        "锁止与高压状态允许不一致的时间,因两种报文并非同时发送",
    ),
)

_UNLOCKED = Text(
    "not locked for {seconds:.2f} s while the state is HV closed",
    "状态为 HV closed 时未上锁,持续 {seconds:.2f} s",
)
_APART = Text(
    "Not connected for {seconds:.2f} s while the state is HV closed",
    "状态为 HV closed 时换电连接器未连接,持续 {seconds:.2f} s",
)


class LockWhileVoltage(LastingWatcher):
    """Judges lock and connector under the state HV closed."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        seconds = findings.limit(_SECONDS)
        self._unlocked, self._apart = (
            self.lasting(Subject("BSU", "BSU_BMS_0", signal), seconds, BSU_BMS_0)
            for signal in ("BSU_Lock", "BSU_ConnectSt")
        )

    def feed(self, chunk: Chunk) -> None:
        """Judge the swap controller's reports while there is high voltage."""
        series = chunk.sound(BSU_BMS_0)
        state = LastKnown(chunk.sound(B2V_ST1), series)
        judged = state.is_code("bms", BmsState.HV_CLOSED)
        unlocked = series.raw("lock") != LockState.LOCKED
        apart = series.raw("connect_st") == ConnectorState.NOT_CONNECTED
        self._unlocked.feed(series, judged, unlocked, partial(_describe, _UNLOCKED))
        self._apart.feed(series, judged, apart, partial(_describe, _APART))


def _describe(text: Text, _: int) -> Said:
    return text, {}


RULE = Rule(
    id="lock-while-voltage",
    title=Text("High voltage only while locked and connected", "高压闭合时电池包已上锁且已连接"),
    purpose=Text(
        "A connector that parts under voltage draws an arc, and a pack that is not locked can "
        "fall.",
        "带电断开连接器会产生电弧,未锁止的电池包可能脱落。",
    ),
    clause="Table 17 rows 2 and 3 (5.2.4)",
    severity=Severity.SHOULD,
    judges=("BSU",),
    tolerances=(_SECONDS,),
    watch=LockWhileVoltage,
)
