"""A signal that only names reserved bits stays."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, gone, place
from dbcspec.compare.senses import is_reserved
from typedcan.model.protocol import Signal


def says_reserved(signal: Signal) -> bool:
    """Whether a signal says of itself that its bits are reserved."""
    return is_reserved(signal.title or signal.english) or any(
        part.casefold().rstrip("0123456789") in ("reserve", "reserved", "rsvd", "spare")
        for part in signal.name.split("_")
    )


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        for signal in message.removed:
            if says_reserved(signal):
                yield gone(
                    message.new.name, signal.name, "reserved field", place(signal), signal.where
                )


PROMISE = Promise(
    "reserved-signal-present",
    "Bits that had a name, though only as reserved ones, still have one.",
    Class.SOURCE,
    Breaks.RECEIVER,
    _check,
)
