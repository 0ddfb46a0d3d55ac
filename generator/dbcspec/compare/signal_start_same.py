"""A signal keeps its place."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, signal_change


def _check(pairing: Pairing) -> Iterator[Change]:
    for signal in pairing.signals:
        old, new = signal.old, signal.new
        # Start bits of different byte orders count from different ends.
        if old.byte_order is new.byte_order and old.start != new.start:
            yield signal_change(signal, "start bit", str(old.start), str(new.start))


PROMISE = Promise(
    "signal-start-same",
    "A signal begins at the same bit.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
