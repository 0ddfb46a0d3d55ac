"""Checksums and alive counters."""

from __future__ import annotations

from swapcan.conform.rule import Rule
from swapcan.conform.rules.protection import (
    checksum,
    counter_allowed,
    counter_sequence,
)
from typedcan.wire.protocol import Protocol


def rules(protocol: Protocol) -> tuple[Rule, ...]:
    """Those of a protocol, in the order of reports."""
    return (
        checksum.rule(protocol),
        counter_sequence.rule(protocol),
        counter_allowed.rule(protocol),
    )
