"""The cooling unit, and what it is told: tables 19 (5.5) and 20."""

from __future__ import annotations

from swapcan.rules.cooling import (
    charge_states_agree,
    cooling_mode_followed,
    cooling_told_relays,
    cooling_told_voltage,
    cooling_voltage_asked,
)
from typedcan.judge.rule import Rule

RULES: tuple[Rule, ...] = (
    charge_states_agree.RULE,
    cooling_told_voltage.RULE,
    cooling_told_relays.RULE,
    cooling_mode_followed.RULE,
    cooling_voltage_asked.RULE,
)
