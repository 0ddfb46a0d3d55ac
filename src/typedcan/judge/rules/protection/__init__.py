"""Checksums and alive counters."""

from __future__ import annotations

from typedcan.judge.rule import Rule
from typedcan.judge.rules.protection import checksum, counter_allowed, counter_sequence
from typedcan.judge.scope import Scope
from typedcan.wire.protocol import Protocol


def rules(protocol: Protocol, scope: Scope) -> tuple[Rule, ...]:
    """Those of a protocol, in the order of reports."""
    return (
        checksum.rule(protocol),
        counter_sequence.rule(protocol, scope),
        counter_allowed.rule(protocol),
    )
