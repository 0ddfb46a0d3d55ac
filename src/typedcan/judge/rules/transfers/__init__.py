"""Values that take several frames, by the kinds of their transfers."""

from __future__ import annotations

from typedcan.judge.rule import Rule
from typedcan.judge.rules.transfers import cycle_watch, frame_numbers
from typedcan.judge.scope import Scope
from typedcan.wire.protocol import Protocol


def rules(protocol: Protocol, scope: Scope) -> tuple[Rule, ...]:
    """Those of a protocol, in the order of reports."""
    return (*cycle_watch.rules(protocol, scope), frame_numbers.rule(protocol))
