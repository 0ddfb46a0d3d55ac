"""The cooling unit is told the same charging state as the VCU."""

from __future__ import annotations

from swapcan.messages import B2V_ST1, BMS_TMS_0
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="charge-states-agree.seconds",
    value=1.5,
    unit="s",
    text=Text(
        "for which they may differ: a period and a half of BMS_TMS_0",
        "允许不一致的时间:BMS_TMS_0 的一个半周期",
    ),
)

_SUBJECT = Subject("BMU", "BMS_TMS_0", "BMS_ChrgSts")

_DIFFERS = Text(
    "{cooling} where B2V_ST1_ChgSt is {truck}; not the same for {seconds:.2f} s",
    "此处为 {cooling},而 B2V_ST1_ChgSt 为 {truck},不一致持续 {seconds:.2f} s",
)


class ChargeStatesAgree(LastingWatcher):
    """Holds each BMS_TMS_0 against the last B2V_ST1."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._differs = self.lasting(_SUBJECT, findings.limit(_SECONDS), BMS_TMS_0)

    def feed(self, chunk: Chunk) -> None:
        """Judge the charging states."""
        series = chunk.sound(BMS_TMS_0)
        state = LastKnown(chunk.sound(B2V_ST1), series)
        cooling, truck = series.raw("chrg_sts"), state.raw("chg_st")
        labels = B2V_ST1.FIELDS["chg_st"].labels

        def describe(row: int) -> Said:
            told = {"cooling": labels[int(cooling[row])], "truck": labels[int(truck[row])]}
            return _DIFFERS, told

        self._differs.feed(series, state.known, cooling != truck, describe)


RULE = Rule(
    id="charge-states-agree",
    title=Text("One charging state for all", "充电状态对各方一致"),
    purpose=Text(
        "Both signals are the charging state with the same codes: the cooling unit prepares for "
        "charging by it.",
        "两个信号均为充电状态且编码相同,水冷机组据此为充电做准备。",
    ),
    clause="Table 19 row 3 (5.5), Table 1 row 13 (5.1.1)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_SECONDS,),
    watch=ChargeStatesAgree,
)
