"""A message keeps its sender."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, message_change


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        (old,), new = pairing.continued([message.old.sender]), message.new.sender
        if old != new:
            yield message_change(message, "sender", message.old.sender, new)


PROMISE = Promise(
    "message-sender-same",
    "A message comes from the same node.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
