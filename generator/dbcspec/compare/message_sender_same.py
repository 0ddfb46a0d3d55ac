"""A message keeps its sender, and all of them where there are several."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, listed, message_change


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        old, new = pairing.continued(message.old.senders), message.new.senders
        if old != new:
            yield message_change(message, "sender", listed(message.old.senders), listed(new))


PROMISE = Promise(
    "message-sender-same",
    "A message comes from the same nodes.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
