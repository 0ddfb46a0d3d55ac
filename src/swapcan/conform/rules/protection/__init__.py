"""Checksums and alive counters."""

from __future__ import annotations

from swapcan.conform.rule import Rule
from swapcan.conform.rules.protection import checksum, counter_allowed, counter_sequence

RULES: tuple[Rule, ...] = (checksum.RULE, counter_sequence.RULE, counter_allowed.RULE)
