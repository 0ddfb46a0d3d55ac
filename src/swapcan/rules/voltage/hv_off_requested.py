"""The VCU switches off where the pack asks for it."""

from __future__ import annotations

import numpy as np

from swapcan.messages import B2V_RQ, B2V_ST1, V2B_CMD, HvCommand, HvOffRequest
from swapcan.rules.shared import ANOTHER_PACK
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.measure.last_known import LastKnown
from typedcan.judge.measure.since import Since
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SECONDS = Tolerance(
    name="hv-off-requested.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "from the request to the command HV Off; the standard names no time, and a truck that "
        "moves should not lose its drive at once",
        "从请求下高压到发出下高压指令的时间;标准未规定,行驶中的车辆不宜立即失去动力",
    ),
)

_SUBJECT = Subject("VCU", "V2B_CMD", "V2B_CMD_HV_OnOff")

_IGNORED = Text(
    "no command HV Off for {seconds:.2f} s, while the BMU requests high voltage off",
    "BMU 请求下高压,{seconds:.2f} s 内未发出下高压指令",
)


class HvOffRequested(LastingWatcher):
    """Measures how long the VCU does not command off under a request."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._ignored = self.lasting(_SUBJECT, findings.limit(_SECONDS), V2B_CMD)
        self._another = findings.limit(ANOTHER_PACK)
        self._heard = Since(self._another)

    def feed(self, chunk: Chunk) -> None:
        """Judge the commands while a request is in force."""
        commands, states = chunk.sound(V2B_CMD), chunk.sound(B2V_ST1)
        requests = chunk.sound(B2V_RQ)
        heard = self._heard.feed(states, np.ones(len(states), np.bool_))
        if not len(requests) or not len(states):
            return
        request, pack = LastKnown(requests, commands), LastKnown(states, commands)
        judged = request.is_code("hv_off", HvOffRequest.REQUEST_HV_OFF) & pack.known
        judged &= requests.time[request.rows] >= heard[pack.rows] - self._another
        wrong = commands.raw("hv_on_off") != HvCommand.HV_OFF
        self._ignored.feed(commands, judged, wrong, _describe)


def _describe(_: int) -> Said:
    return _IGNORED, {}


RULE = Rule(
    id="hv-off-requested",
    title=Text("The VCU obeys the request for high voltage off", "VCU 响应下高压请求"),
    purpose=Text(
        "The BMU asks for it where the pack is in danger; if nobody obeys, it has to open its "
        "relays under load.",
        "电池包处于危险时 BMU 请求下高压;若无响应,只能带载断开继电器。",
    ),
    clause="Table 3 row 2 (5.1.3), 5.1.11",
    severity=Severity.SHOULD,
    judges=("VCU",),
    tolerances=(_SECONDS, ANOTHER_PACK),
    watch=HvOffRequested,
)
