"""When messages come."""

from __future__ import annotations

from swapcan.conform.rule import Rule
from swapcan.conform.rules.timing import (
    bus_load,
    event_repeated,
    message_missing,
    node_silence,
    period_gap,
    period_jitter,
    period_mean,
    period_short,
    relays_before_command,
    start_complete,
    start_state,
)

RULES: tuple[Rule, ...] = (
    period_mean.RULE,
    period_jitter.RULE,
    period_gap.RULE,
    period_short.RULE,
    node_silence.RULE,
    event_repeated.RULE,
    message_missing.RULE,
    start_complete.RULE,
    start_state.RULE,
    relays_before_command.RULE,
    bus_load.RULE,
)
