"""What nodes tell of themselves that is worth knowing."""

from __future__ import annotations

from swapcan.rules.notices import (
    alarm_raised,
    charger_fault_told,
    connector_warning_told,
    cooling_fault_told,
    hv_off_asked,
    hv_on_failed,
    lock_while_voltage,
)
from typedcan.judge.rule import Rule

RULES: tuple[Rule, ...] = (
    lock_while_voltage.RULE,
    alarm_raised.RULE,
    hv_on_failed.RULE,
    hv_off_asked.RULE,
    charger_fault_told.RULE,
    cooling_fault_told.RULE,
    connector_warning_told.RULE,
)
