"""A signal keeps its byte order."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, signal_change
from typedcan.model.layout import bits
from typedcan.model.protocol import Signal


def _check(pairing: Pairing) -> Iterator[Change]:
    for signal in pairing.signals:
        old, new = signal.old, signal.new
        if old.byte_order is not new.byte_order and not _on_the_same_bits(old, new):
            yield signal_change(signal, "byte order", old.byte_order.value, new.byte_order.value)


def _on_the_same_bits(old: Signal, new: Signal) -> bool:
    """Whether both orders describe the same bits, as within one byte; the longer may go on."""
    shorter = min(old.length, new.length)
    return bits(old)[:shorter] == bits(new)[:shorter]


PROMISE = Promise(
    "signal-byte-order-same",
    "The bits of a signal follow each other in the same order.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
