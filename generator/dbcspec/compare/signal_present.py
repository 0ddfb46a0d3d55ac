"""A signal stays."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, gone, place
from dbcspec.compare.reserved_signal_present import says_reserved


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        for signal in message.removed:
            if not says_reserved(signal):
                yield gone(message.new.name, signal.name, "signal", place(signal), signal.where)


PROMISE = Promise(
    "signal-present",
    "A signal that was in a message still is.",
    Class.WIRE,
    Breaks.RECEIVER,
    _check,
)
