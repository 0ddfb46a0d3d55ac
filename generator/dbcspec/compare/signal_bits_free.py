"""A new signal takes no bits of one that stays."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.overlaps import taken_by
from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, place


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        for signal in message.added:
            other = taken_by(signal, message)
            if other is not None:
                text = f"new signal at {place(signal)}, where {other.name} is"
                yield Change(
                    message=message.new.name,
                    subject=signal.name,
                    text=text,
                    old=other.name,
                    new=place(signal),
                    where=signal.where,
                )


PROMISE = Promise(
    "signal-bits-free",
    "A new signal takes no bits that another signal has and keeps.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
