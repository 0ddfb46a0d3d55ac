"""A signal keeps its start value."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, signal_change
from dbcspec.compare.spec_only import start_follows
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for signal in pairing.signals:
        old, new = signal.old.start_value, signal.new.start_value
        if old != new and not start_follows(pairing, signal):
            yield signal_change(signal, "start value", str(old), str(new))


PROMISE = Promise(
    "signal-start-value-same",
    "A signal holds the same raw value before anything else is known.",
    Class.WIRE,
    Breaks.RECEIVER,
    _check,
    needs=Aspect.START_VALUES,
)
