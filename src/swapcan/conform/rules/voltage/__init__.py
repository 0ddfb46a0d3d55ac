"""The high-voltage sequence of clause 5.2.1."""

from __future__ import annotations

from swapcan.conform.rule import Rule

RULES: tuple[Rule, ...] = ()
