"""Requests and their answers."""

from __future__ import annotations

from swapcan.conform.rule import Rule
from swapcan.conform.rules.requests import answer_in_time, answer_unasked, request_withdrawn

RULES: tuple[Rule, ...] = (
    answer_in_time.RULE,
    answer_unasked.RULE,
    request_withdrawn.RULE,
)
