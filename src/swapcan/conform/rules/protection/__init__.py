"""Checksums and alive counters."""

from __future__ import annotations

from swapcan.conform.rule import Rule
from swapcan.conform.rules.protection import checksum

RULES: tuple[Rule, ...] = (checksum.RULE,)
