"""Frames as such: identifiers, kinds, lengths, reserved bits."""

from __future__ import annotations

from typedcan.judge.rule import Rule
from typedcan.judge.rules.frames import (
    error_frames,
    foreign_frames,
    frame_kind,
    frame_length,
    identifier_priority,
    message_one_channel,
    reserved_bits,
    source_address,
    unassigned_bits,
)
from typedcan.wire.protocol import Protocol


def rules(protocol: Protocol) -> tuple[Rule, ...]:
    """Those of a protocol, in the order of reports."""
    return (
        frame_kind.rule(protocol),
        frame_length.rule(protocol),
        *_rules_of_addresses(protocol),
        reserved_bits.rule(protocol),
        unassigned_bits.rule(protocol),
        foreign_frames.rule(protocol),
        error_frames.rule(protocol),
        message_one_channel.rule(protocol),
    )


def _rules_of_addresses(protocol: Protocol) -> tuple[Rule, ...]:
    """Where the nodes have source addresses, identifiers are read as J1939 divides them."""
    if all(node.address is None for node in protocol.model.nodes):
        return ()
    return identifier_priority.rule(protocol), source_address.rule(protocol)
