"""The cooling unit is told what the main relays do."""

from __future__ import annotations

from functools import partial

from swapcan.messages import B2V_ST0, BMS_TMS_0, HvRelayState, RelayState
from swapcan.rules.voltage.charge_path import MAIN, ChargePath
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="cooling-told-relays.seconds",
    value=1.5,
    unit="s",
    text=Text(
        "for which they may differ: a period and a half of BMS_TMS_0",
        "允许不一致的时间:BMS_TMS_0 的一个半周期",
    ),
)

_SUBJECT = Subject("BMU", "BMS_TMS_0", "BMS_HVRlySts")

_OPEN = Text(
    "told Closed for {seconds:.2f} s while a main relay is open",
    "主继电器断开时仍报闭合,持续 {seconds:.2f} s",
)
_CLOSED = Text(
    "told Open for {seconds:.2f} s while both main relays are closed",
    "主正、主负继电器均闭合时仍报断开,持续 {seconds:.2f} s",
)


class CoolingToldRelays(LastingWatcher):
    """Holds each BMS_TMS_0 against the last B2V_ST0."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        seconds = findings.limit(_SECONDS)
        self._open = self.lasting(_SUBJECT, seconds, BMS_TMS_0)
        self._closed = self.lasting(_SUBJECT, seconds, BMS_TMS_0)
        self._path = ChargePath()

    def feed(self, chunk: Chunk) -> None:
        """Judge the state of the relays."""
        series = chunk.sound(BMS_TMS_0)
        relays = LastKnown(chunk.sound(B2V_ST0), series)
        main = [relays.raw(field) for field in MAIN]
        is_open = relays.known & ((main[0] == RelayState.OPEN) | (main[1] == RelayState.OPEN))
        for for_charging in self._path.feed(chunk).values():
            if len(for_charging):
                is_open &= ~for_charging[relays.rows]
        is_closed = relays.known & (main[0] == RelayState.CLOSED) & (main[1] == RelayState.CLOSED)
        told = series.raw("hv_rly_sts")
        self._open.feed(series, is_open, told == HvRelayState.CLOSED, partial(_describe, _OPEN))
        self._closed.feed(series, is_closed, told == HvRelayState.OPEN, partial(_describe, _CLOSED))


def _describe(text: Text, _: int) -> Said:
    return text, {}


RULE = Rule(
    id="cooling-told-relays",
    title=Text("The cooling unit is told the main relays", "发给水冷机组的高压继电器状态属实"),
    purpose=Text(
        "The unit starts its compressor where it is told that there is high voltage. Which relay "
        "is meant is not printed: the main ones are read, but for one that opened for charging.",
        "机组据此判断能否起动压缩机。标准未说明所指继电器,按主继电器理解,因充电而断开的除外。",
    ),
    clause="Table 19 row 4 (5.5), Table 2 rows 1 and 2 (5.1.2)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_SECONDS,),
    watch=CoolingToldRelays,
)
