"""What single signals say: codes and ranges."""

from __future__ import annotations

from swapcan.conform.rule import Rule

RULES: tuple[Rule, ...] = ()
