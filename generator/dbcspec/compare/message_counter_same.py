"""A message keeps its alive counter."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, message_change
from dbcspec.compare.protection import protection_follows
from typedcan.model.protection import Counter
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        old, new = message.old.counter, message.new.counter
        if old != new and not protection_follows(message, old, new):
            yield message_change(message, "counter", _text(old), _text(new))


def _text(counter: Counter | None) -> str:
    return f"{counter} in {counter.signal}" if counter else ""


PROMISE = Promise(
    "message-counter-same",
    "A message counts in the same signal, through as many values.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
    needs=Aspect.PROTECTION,
)
