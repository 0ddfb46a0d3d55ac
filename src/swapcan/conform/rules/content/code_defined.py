"""Codes are those that the value tables have."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Said
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.content.codes import Codes, judge_codes, senders, wrong_codes
from swapcan.conform.text import Text
from swapcan.messages import (
    B2V_ST4,
    B2V_ST5,
    B2V_ST6,
    V2B_VIN,
    B2V_SysCode1,
    B2V_Temp,
    B2V_Ucell,
)
from typedcan.wire.message import Field, LabelledField

_OPEN = {(B2V_SysCode1, "manufacturer"), (B2V_SysCode1, "sys_code_length")}
"""Table 8 row 2 names five manufacturers of many; row 3 labels one number of 32."""

_FROM_ONE = (
    (B2V_Ucell, "frame_no"),
    (B2V_Ucell, "csc_no"),
    (B2V_Temp, "frame_no"),
    (B2V_Temp, "csc_no"),
    (B2V_ST4, "max_temp_csc_no"),
    (B2V_ST4, "min_temp_csc_no"),
    (B2V_ST5, "max_ucell_csc_no"),
    (B2V_ST6, "min_ucell_csc_no"),
)
"""Tables 6, 7, 9 and 10 number frames and CSCs from 1; how far depends on the pack."""

_VIN_FRAMES = range(1, 4)
"""Table 15 row 1."""

_UNDEFINED = Text(
    "code {code} has no meaning; defined are {defined}",
    "编码 {code} 未定义,已定义的编码为 {defined}",
)
_NUMBERED_FROM_ONE = Text("number {code}; numbers begin at 1", "编号为 {code},编号应从 1 开始")


def _labelled() -> Iterator[Codes]:
    for message in PROTOCOL.messages:
        for field in message.FIELDS.values():
            if not isinstance(field, LabelledField) or (message, field.name) in _OPEN:
                continue
            undefined = _without(field, field.labels)
            if undefined:
                yield wrong_codes(message, field, undefined)


def _without(field: Field, defined: Collection[int]) -> list[int]:
    return [code for code in range(1 << field.length) if code not in defined]


_VIN_FRAME = V2B_VIN.FIELDS["frame_no"]
_TABLES = (*_labelled(), wrong_codes(V2B_VIN, _VIN_FRAME, _without(_VIN_FRAME, _VIN_FRAMES)))
_NUMBERS = tuple(wrong_codes(message, message.FIELDS[name], (0,)) for message, name in _FROM_ONE)


class CodeDefined(Watcher):
    """Holds codes against the value tables."""

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_codes(self.findings, chunk, _TABLES, _describe)
        judge_codes(self.findings, chunk, _NUMBERS, _describe_number)


def _describe(codes: Codes, code: int) -> Said:
    return _UNDEFINED, {"code": code, "defined": ", ".join(map(str, codes.right))}


def _describe_number(codes: Codes, code: int) -> Said:  # noqa: ARG001
    return _NUMBERED_FROM_ONE, {"code": code}


RULE = Rule(
    id="code-defined",
    title=Text("Codes have a meaning", "编码有定义"),
    purpose=Text(
        "Nobody knows what a code says that the value table does not have. Tables that number "
        "CSCs and frames count as examples: a pack may have more of them, but none has number 0. "
        "Positions, manufacturers and the length of the pack code are left open.",
        "编码定义中没有的编码,接收方无法理解。"
        "CSC 编号和帧序号的编码表视为示例:电池包可以有更多编号,但不应为 0。"
        "位置编号、电池厂家和编码长度不作限制。",
    ),
    clause="Tables 1 to 20",
    severity=Severity.MUST,
    judges=senders((*_TABLES, *_NUMBERS)),
    watch=CodeDefined,
)
