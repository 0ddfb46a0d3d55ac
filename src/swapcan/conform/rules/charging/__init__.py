"""Charging and the charger."""

from __future__ import annotations

from swapcan.conform.rule import Rule

RULES: tuple[Rule, ...] = ()
