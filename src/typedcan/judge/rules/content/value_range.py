"""Values are inside their range."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.content.codes import (
    Codes,
    Span,
    judge_codes,
    senders,
    whole_fields,
    without,
)
from typedcan.report.language import Text
from typedcan.wire.fields import Field, NumberField, PhysicalField
from typedcan.wire.protocol import Protocol

_OUTSIDE = Text(
    "{value:.10g} {unit} (code {code}) is outside {low:.10g} to {high:.10g} {unit}",
    "{value:.10g} {unit}(编码 {code})超出范围 {low:.10g}~{high:.10g} {unit}",
)


class ValueRange(Watcher):
    """Looks for codes outside the range that mean nothing else."""

    def __init__(self, findings: Findings, codes: Sequence[Codes]) -> None:
        super().__init__(findings)
        self._codes = codes

    def feed(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_codes(self.findings, chunk, self._codes, _describe, _excess)


def _outside(field: Field) -> tuple[Span, ...]:
    """Most ranges are as wide as their bits and cannot be left; one without a code is none."""
    lowest, highest = field.signal.raw_limits
    low, high = field.signal.sendable
    return without([(lowest, low - 1), (high + 1, highest)], field.states)


def _excess(codes: Codes, raw: NDArray[Any]) -> NDArray[np.float64]:
    low, high = map(float, codes.field.signal.sendable)
    excess = np.maximum(low - raw, raw - high) * abs(codes.field.factor)
    return excess.astype(np.float64)


def _describe(codes: Codes, code: int) -> Said:
    field = codes.field
    return _OUTSIDE, {
        "value": code * field.factor + field.offset,
        "unit": field.unit,
        "code": code,
        "low": field.minimum,
        "high": field.maximum,
    }


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    codes = tuple(
        Codes(message, field, _outside(field))
        for message, field in whole_fields(protocol)
        if isinstance(field, PhysicalField | NumberField) and _outside(field)
    )
    return Rule(
        id="value-range",
        title=Text("Values are inside their range", "数值在实际范围内"),
        purpose=Text(
            "A receiver may refuse a value that cannot be.",
            "接收方可能拒绝不可能出现的数值。",
        ),
        severity=Severity.MUST,
        judges=senders(codes),
        watch=partial(ValueRange, codes=codes),
    )
