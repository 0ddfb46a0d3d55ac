"""Rule range-fits-bits: a signal's physical range is a range, and its bits can hold it."""

from __future__ import annotations

from collections.abc import Iterator
from decimal import Decimal

from dbcspec.lint.places import Places
from dbcspec.lint.rule import Found, Rule, Subject
from typedcan.model.numbers import number
from typedcan.model.protocol import Signal
from typedcan.model.soundness import has_room

_ROUNDED = Decimal("1e-6")
"""The share of a limit that rounding to the digits of most tools may add."""


def _check(subject: Subject) -> Iterator[Found]:
    places = Places(subject)
    for message, signal in subject.protocol.signals():
        if has_room(message, signal) and (fault := _fault(signal, subject)):
            where = places.meaning(signal, "range")
            yield Found(where, signal.name, f"{signal.name}: {fault}", message.name)


def _fault(signal: Signal, subject: Subject) -> str | None:
    shown = f"{number(signal.minimum)}~{number(signal.maximum)}"
    if signal.minimum == signal.maximum == 0:
        return "the range 0~0 means none at all in a DBC file: give the real one"
    if signal.minimum >= signal.maximum:
        return f"the range {shown} does not ascend: correct it"
    if signal.is_float or not signal.factor:
        return None
    low, high = sorted(raw * signal.factor + signal.offset for raw in signal.raw_limits)
    # Of a limit as it is printed the last digit may be rounded.
    near = max(abs(low), abs(high)) * _ROUNDED
    if not subject.settings.house and any(
        limit != limit.to_integral_value() for limit in (low, high)
    ):
        near = max(near, abs(signal.factor))  # many give 127.875 as 128
    if signal.minimum < low - near or signal.maximum > high + near:
        bits = "bit holds" if signal.length == 1 else "bits hold"
        return (
            f"the range {shown} is not within {number(low)}~{number(high)}, what {signal.length} "
            f"{bits}: correct range, factor or offset"
        )
    return None


RULE = Rule(
    "range-fits-bits",
    "a signal's range is a range, and its bits can hold it",
    _check,
    level="warning",
    foreign=True,
)
