"""Frames as such: identifiers, kinds, lengths, reserved bits."""

from __future__ import annotations

from swapcan.conform.rule import Rule
from swapcan.conform.rules.frames import (
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

RULES: tuple[Rule, ...] = (
    frame_kind.RULE,
    frame_length.RULE,
    identifier_priority.RULE,
    source_address.RULE,
    reserved_bits.RULE,
    unassigned_bits.RULE,
    foreign_frames.RULE,
    error_frames.RULE,
    message_one_channel.RULE,
)
