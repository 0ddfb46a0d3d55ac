"""Whether what a pack says of itself fits together."""

from __future__ import annotations

from swapcan.rules.pack import (
    alarm_level_highest,
    cell_count_announced,
    cell_extremes_equal,
    cell_extremes_place,
    cell_voltages_ordered,
    energy_counters_rise,
    energy_follows_power,
    fault_count,
    probe_count_announced,
    reading_missing,
    soc_continuous,
    soc_follows_current,
    temperature_extremes_equal,
    temperature_extremes_place,
    temperatures_ordered,
    totals_constant,
    voltage_is_sum,
)
from typedcan.judge.rule import Rule

RULES: tuple[Rule, ...] = (
    cell_voltages_ordered.RULE,
    cell_extremes_equal.RULE,
    cell_extremes_place.RULE,
    temperatures_ordered.RULE,
    temperature_extremes_equal.RULE,
    temperature_extremes_place.RULE,
    cell_count_announced.RULE,
    probe_count_announced.RULE,
    totals_constant.RULE,
    reading_missing.RULE,
    voltage_is_sum.RULE,
    soc_continuous.RULE,
    soc_follows_current.RULE,
    energy_counters_rise.RULE,
    energy_follows_power.RULE,
    alarm_level_highest.RULE,
    fault_count.RULE,
)
"""In the order in which reports list them."""
