"""Requests and their answers."""

from __future__ import annotations

from typedcan.judge.rule import Rule
from typedcan.judge.rules.requests import answer_in_time, answer_unasked, request_withdrawn
from typedcan.wire.protocol import Protocol


def rules(protocol: Protocol) -> tuple[Rule, ...]:
    """Those of a protocol, in the order of reports."""
    return (
        answer_in_time.rule(protocol),
        answer_unasked.rule(protocol),
        request_withdrawn.rule(protocol),
    )
