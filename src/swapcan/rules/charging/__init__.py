"""Charging: tables 18 and 19 (5.4), and rows 3 and 11 to 13 of table 1."""

from __future__ import annotations

from swapcan.rules.charging import (
    charge_current_sign,
    charge_limited_when_hot,
    charge_line_connected,
    charge_stops_on_fault,
    charger_current_limit,
    charger_own_bus,
    charger_stops,
    charger_voltage_limit,
)
from typedcan.judge.rule import Rule

RULES: tuple[Rule, ...] = (
    charger_own_bus.RULE,
    charge_line_connected.RULE,
    charge_current_sign.RULE,
    charger_voltage_limit.RULE,
    charger_current_limit.RULE,
    charger_stops.RULE,
    charge_stops_on_fault.RULE,
    charge_limited_when_hot.RULE,
)
