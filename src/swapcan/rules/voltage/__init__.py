"""The high-voltage sequence of clause 5.2.1, and the currents of 5.1.4."""

from __future__ import annotations

from swapcan.rules.voltage import (
    bus_voltage_follows,
    discharge_limit,
    drive_ends_on_alarm,
    feedback_limit,
    hv_closed_relays,
    hv_off_in_time,
    hv_off_requested,
    hv_on_in_time,
    hv_only_on_command,
    hv_state_order,
    precharge_first,
    precharge_in_time,
)
from typedcan.judge.rule import Rule

RULES: tuple[Rule, ...] = (
    hv_only_on_command.RULE,
    hv_on_in_time.RULE,
    precharge_first.RULE,
    precharge_in_time.RULE,
    hv_state_order.RULE,
    hv_closed_relays.RULE,
    bus_voltage_follows.RULE,
    hv_off_in_time.RULE,
    hv_off_requested.RULE,
    drive_ends_on_alarm.RULE,
    discharge_limit.RULE,
    feedback_limit.RULE,
)
