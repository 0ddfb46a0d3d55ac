"""Frames as such: identifiers, kinds, lengths, reserved bits."""

from __future__ import annotations

from swapcan.conform.rule import Rule

RULES: tuple[Rule, ...] = ()
