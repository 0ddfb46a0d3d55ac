"""Watching periods by both readings, where the frames of a message take turns."""

from __future__ import annotations

from collections.abc import Collection
from functools import partial
from typing import Protocol as TypingProtocol

from typedcan.judge.chunk import LogEnd
from typedcan.judge.findings import Findings
from typedcan.judge.measure.steps import keyed
from typedcan.judge.rule import Watcher
from typedcan.judge.rules.one_of import OneOf, Together
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol


class Making(TypingProtocol):
    """Makes what watches some messages, those of several frames a cycle by cycle or by frame."""

    def __call__(
        self, findings: Findings, *, messages: Collection[type[Message]], by_frame: bool
    ) -> Watcher:
        """Make it."""
        ...


def watch_periods(findings: Findings, protocol: Protocol, make: Making) -> Watcher:
    """Watch the messages of a protocol that have a period.

    Of one whose frames take turns it may be the period of a frame, or of all: the log shows it.
    """
    turns = keyed(protocol)
    plain = [each for each in protocol.messages if each.PERIOD and each not in turns]
    both = [
        OneOf(
            findings,
            [partial(make, messages=(message,), by_frame=by_frame) for by_frame in (False, True)],
            partial(_is_by_frame, message),
        )
        for message in turns
        if message.PERIOD
    ]
    return Together(findings, [make(findings, messages=plain, by_frame=False), *both])


def _is_by_frame(message: type[Message], end: LogEnd) -> int:
    return int(message in end.by_frame)
