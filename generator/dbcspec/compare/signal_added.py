"""No signal is new."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.overlaps import taken_by
from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, fresh, place


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        for signal in message.added:
            if taken_by(signal, message) is None:
                yield fresh(message.new.name, signal.name, "signal", place(signal), signal.where)


PROMISE = Promise(
    "signal-added",
    "A signal that is in a message was there before; reserved bits stay reserved.",
    Class.ADDITIVE,
    Breaks.NOBODY,
    _check,
)
