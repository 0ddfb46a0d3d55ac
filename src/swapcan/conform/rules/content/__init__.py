"""What single signals say: codes and ranges."""

from __future__ import annotations

from swapcan.conform.rule import Rule
from swapcan.conform.rules.content import (
    code_defined,
    code_reserved,
    invalid_lasting,
    value_range,
)

RULES: tuple[Rule, ...] = (
    code_defined.RULE,
    value_range.RULE,
    code_reserved.RULE,
    invalid_lasting.RULE,
)
