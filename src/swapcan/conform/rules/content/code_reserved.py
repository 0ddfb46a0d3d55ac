"""Codes that are reserved are not sent."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Said
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.content.codes import Codes, judge_codes, senders, wrong_codes
from swapcan.conform.text import Text
from swapcan.messages import B2V_ST1
from typedcan.wire.message import Field

_ONLY_CODE = {(B2V_ST1, "chg_mode")}
"""Table 1 row 12 has no other code for a pack that is not charging."""

_RESERVED = Text("code {code} is reserved", "编码 {code} 为保留编码")


def _reserved(field: Field) -> list[int]:
    return [code for code, label in field.labels.items() if label == "Reserved"]


_CODES = tuple(
    wrong_codes(message, field, _reserved(field))
    for message in PROTOCOL.messages
    for field in message.FIELDS.values()
    if _reserved(field) and (message, field.name) not in _ONLY_CODE
)


class CodeReserved(Watcher):
    """Looks for codes whose label is Reserved."""

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_codes(self.findings, chunk, _CODES, _describe)


def _describe(codes: Codes, code: int) -> Said:  # noqa: ARG001
    return _RESERVED, {"code": code}


RULE = Rule(
    id="code-reserved",
    title=Text("Reserved codes are not sent", "不发送保留编码"),
    purpose=Text(
        "A reserved code says nothing; what is not known or not there has a code for that. "
        "B2V_ST1_ChgMode is not judged, as only 0 is left for it while nothing charges.",
        "保留编码没有含义;状态未知或不存在时应发送无效编码。B2V_ST1_ChgMode 不判定,"
        "因为不充电时只有编码 0 可用。",
    ),
    clause="Tables 2, 3, 13 and 14",
    severity=Severity.SHOULD,
    judges=senders(_CODES),
    watch=CodeReserved,
)
