"""The cooling unit closes its high-voltage relay only where it is asked to."""

from __future__ import annotations

from swapcan.messages import BMS_TMS_0, TMS_BMS_0, HvRelayState, HvRequest
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="cooling-voltage-asked.seconds",
    value=3.0,
    unit="s",
    text=Text(
        "from the request for high voltage off to the open relay: messages of 1 s, and what the "
        "compressor needs to stop",
        "从请求下高压到继电器断开的时间:报文周期 1 s,以及压缩机停机所需时间",
    ),
)

_SUBJECT = Subject("TMS", "TMS_BMS_0", "TMS_HVRlySts")

_CLOSED = Text(
    "high-voltage relay closed for {seconds:.2f} s while the BMS requests high voltage off",
    "BMS 请求下高压期间,高压继电器闭合达 {seconds:.2f} s",
)


class CoolingVoltageAsked(LastingWatcher):
    """Judges the relay under the request for high voltage off."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._closed = self.lasting(_SUBJECT, findings.limit(_SECONDS), TMS_BMS_0)

    def feed(self, chunk: Chunk) -> None:
        """Judge the unit's relay."""
        series = chunk.sound(TMS_BMS_0)
        order = LastKnown(chunk.sound(BMS_TMS_0), series)
        judged = order.is_code("reqst_tms_hv_on", HvRequest.REQUEST_HV_OFF)
        closed = series.raw("hv_rly_sts") == HvRelayState.CLOSED
        self._closed.feed(series, judged, closed, _describe)


def _describe(_: int) -> Said:
    return _CLOSED, {}


RULE = Rule(
    id="cooling-voltage-asked",
    title=Text("The cooling unit has high voltage only when asked to", "水冷机组仅按请求上高压"),
    purpose=Text(
        "The BMS asks for high voltage on and off: it opens its relays in the belief that the "
        "unit draws nothing.",
        "高压上下电由 BMS 请求;BMS 断开继电器时认为机组已无负载。",
    ),
    clause="Table 19 row 2 (5.5), Table 20 row 2 (5.6)",
    severity=Severity.SHOULD,
    judges=("TMS",),
    tolerances=(_SECONDS,),
    watch=CoolingVoltageAsked,
)
