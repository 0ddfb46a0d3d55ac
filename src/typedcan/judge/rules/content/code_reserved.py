"""Codes that are reserved are not sent."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.content.codes import Codes, judge_codes, senders, whole_fields
from typedcan.judge.scope import Scope
from typedcan.report.language import Text
from typedcan.wire.fields import Field
from typedcan.wire.protocol import Protocol

_RESERVED = Text("code {code} is reserved", "编码 {code} 为保留编码")
_LABEL = "reserved"


class CodeReserved(Watcher):
    """Looks for codes whose label is Reserved."""

    def __init__(self, findings: Findings, codes: Sequence[Codes]) -> None:
        super().__init__(findings)
        self._codes = codes

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_codes(self.findings, chunk, self._codes, _describe)


def _describe(codes: Codes, code: int) -> Said:  # noqa: ARG001
    return _RESERVED, {"code": code}


def _reserved(field: Field) -> tuple[tuple[int, int], ...]:
    found = sorted(code for code, label in field.labels.items() if label.lower() == _LABEL)
    return tuple((code, code) for code in found)


def rule(protocol: Protocol, scope: Scope) -> Rule:
    """The rule of a protocol."""
    codes = tuple(
        Codes(message, field, _reserved(field))
        for message, field in whole_fields(protocol)
        if _reserved(field) and field.dbc_name not in scope.reserved_used
    )
    return Rule(
        id="code-reserved",
        title=Text("Reserved codes are not sent", "不发送保留编码"),
        purpose=Text(
            "A reserved code says nothing; what is not known or not there has a code for that.",
            "保留编码没有含义;状态未知或不存在时应发送无效编码。",
        ),
        severity=Severity.SHOULD,
        judges=senders(codes),
        watch=partial(CodeReserved, codes=codes),
    )
