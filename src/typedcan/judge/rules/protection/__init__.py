"""Checksums and alive counters."""

from __future__ import annotations

from typedcan.judge.rule import Rule
from typedcan.judge.rules.protection import checksum, counter_allowed, counter_sequence
from typedcan.wire.protocol import Protocol


def rules(protocol: Protocol) -> tuple[Rule, ...]:
    """Those of a protocol, in the order of reports."""
    return (
        checksum.rule(protocol),
        counter_sequence.rule(protocol),
        counter_allowed.rule(protocol),
    )
