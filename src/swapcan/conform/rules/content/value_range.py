"""Values are inside the printed range."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Said
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.content.codes import Codes, judge_codes, senders, wrong_codes
from swapcan.conform.text import Text
from typedcan.wire.message import Field, NumberField, PhysicalField

_OUTSIDE = Text(
    "{value:.10g} {unit} (code {code}) is outside {low:.10g} to {high:.10g} {unit}",
    "{value:.10g} {unit}(编码 {code})超出范围 {low:.10g}~{high:.10g} {unit}",
)


def _limits(field: Field) -> tuple[int, int]:
    """The lowest and the highest raw code of the printed range."""
    low, high = (
        round((limit - field.offset) / field.factor) for limit in (field.minimum, field.maximum)
    )
    return low, high


def _outside(field: Field) -> list[int]:
    low, high = _limits(field)
    narrow = (*range(low), *range(high + 1, 1 << field.length))
    return [code for code in narrow if code not in field.states]


_CODES = tuple(
    wrong_codes(message, field, _outside(field))
    for message in PROTOCOL.messages
    for field in message.FIELDS.values()
    if isinstance(field, PhysicalField | NumberField) and _outside(field)
)
"""Most printed ranges are as wide as their bits and cannot be left."""


class ValueRange(Watcher):
    """Looks for codes outside the range that mean nothing else."""

    def take(self, chunk: Chunk) -> None:
        """Judge the next frames."""
        judge_codes(self.findings, chunk, _CODES, _describe, _excess)


def _excess(codes: Codes, raw: NDArray[np.int64]) -> NDArray[np.float64]:
    low, high = _limits(codes.field)
    excess: NDArray[np.float64] = np.maximum(low - raw, raw - high) * codes.field.factor
    return excess


def _describe(codes: Codes, code: int) -> Said:
    field = codes.field
    return _OUTSIDE, {
        "value": code * field.factor + field.offset,
        "unit": field.unit,
        "code": code,
        "low": field.minimum,
        "high": field.maximum,
    }


RULE = Rule(
    id="value-range",
    title=Text("Values are inside their range", "数值在实际范围内"),
    purpose=Text(
        "A receiver may refuse a value that cannot be.",
        "接收方可能拒绝不可能出现的数值。",
    ),
    clause="Table 13 rows 9 to 11 (5.1.12), Table 17 row 4 (5.2.4)",
    severity=Severity.MUST,
    judges=senders(_CODES),
    watch=ValueRange,
)
