"""Whether what a pack says of itself fits together."""

from __future__ import annotations

from swapcan.conform.rule import Rule

RULES: tuple[Rule, ...] = ()
