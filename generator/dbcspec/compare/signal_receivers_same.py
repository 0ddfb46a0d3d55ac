"""A signal keeps its receivers."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, listed, signal_change


def _check(pairing: Pairing) -> Iterator[Change]:
    for signal in pairing.signals:
        old, new = signal.old.receivers, signal.new.receivers
        if old != new and set(pairing.continued(old)) != set(new):
            yield signal_change(signal, "receivers", listed(old), listed(new))


PROMISE = Promise(
    "signal-receivers-same",
    "A signal is for the same nodes.",
    Class.WIRE,
    Breaks.RECEIVER,
    _check,
)
