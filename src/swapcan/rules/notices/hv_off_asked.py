"""The pack asked the VCU to switch high voltage off."""

from __future__ import annotations

from swapcan.messages import B2V_RQ, HvOffRequest
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import LastingWatcher
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_SUBJECT = Subject("BMU", "B2V_RQ", "B2V_RQ_HVOff")

_ASKED = Text(
    "high voltage off requested, the last time {seconds:.1f} s after the first",
    "请求下高压,首次与末次请求相隔 {seconds:.1f} s",
)


class HvOffAsked(LastingWatcher):
    """Looks for requests, from the first frame to the last before one is withdrawn."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._asked = self.lasting(_SUBJECT, None, B2V_RQ)

    def feed(self, chunk: Chunk) -> None:
        """Tell of the requests."""
        requests = chunk.sound(B2V_RQ)
        asked = requests.raw("hv_off") == HvOffRequest.REQUEST_HV_OFF
        self._asked.feed(requests, None, asked, _describe)


def _describe(_: int) -> Said:
    return _ASKED, {}


RULE = Rule(
    id="hv-off-asked",
    title=Text("The pack asks for high voltage off", "电池包请求下高压"),
    purpose=Text(
        "The pack sees a danger; what the VCU makes of it is judged apart.",
        "电池包检测到危险;VCU 的响应另行判断。",
    ),
    clause="Table 3 row 2 (5.1.3)",
    severity=Severity.INFO,
    judges=("BMU",),
    watch=HvOffAsked,
)
