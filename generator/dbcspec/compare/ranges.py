"""The ranges of signals before and after, once for both promises that speak of them."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal

from dbcspec.compare.pairing import Pairing, SignalPair
from typedcan.model.numbers import number
from typedcan.model.protocol import Signal


def changed_ranges(pairing: Pairing) -> Iterator[SignalPair]:
    """Signals with other physical limits.

    Limits that are all that the bits can hold, before and after, only follow length and scale.
    """
    for signal in pairing.signals:
        old, new = _limits(signal.old), _limits(signal.new)
        if old != new and not (
            old == _all_that_fits(signal.old) and new == _all_that_fits(signal.new)
        ):
            yield signal


def range_text(signal: Signal) -> str:
    """``0 to 102 %``."""
    unit = f" {signal.unit}" if signal.unit else ""
    return f"{number(signal.minimum)} to {number(signal.maximum)}{unit}"


def _limits(signal: Signal) -> tuple[Decimal, Decimal]:
    return signal.minimum, signal.maximum


def _all_that_fits(signal: Signal) -> tuple[Decimal, Decimal] | None:
    if signal.is_float:
        return None
    ends = sorted(raw * signal.factor + signal.offset for raw in signal.raw_limits)
    return ends[0], ends[1]
