"""When messages come."""

from __future__ import annotations

from typedcan.judge.rule import Rule
from typedcan.judge.rules.timing import (
    bus_load,
    event_repeated,
    message_missing,
    node_awake,
    period_gap,
    period_jitter,
    period_mean,
    period_short,
    start_complete,
)
from typedcan.judge.scope import Scope
from typedcan.wire.protocol import Protocol


def rules(protocol: Protocol, scope: Scope) -> tuple[Rule, ...]:
    """Those of a protocol, in the order of reports."""
    return (
        period_mean.rule(protocol),
        period_jitter.rule(protocol),
        period_gap.rule(protocol),
        period_short.rule(protocol),
        node_awake.rule(protocol, scope),
        event_repeated.rule(protocol),
        message_missing.rule(protocol),
        start_complete.rule(protocol),
        *((bus_load.rule(protocol),) if protocol.model.buses else ()),
    )
