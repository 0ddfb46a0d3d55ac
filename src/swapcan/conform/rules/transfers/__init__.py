"""Values that take several frames."""

from __future__ import annotations

from swapcan.conform.rule import Rule

RULES: tuple[Rule, ...] = ()
