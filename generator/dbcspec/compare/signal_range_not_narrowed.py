"""What could be sent may still be sent."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, signal_change
from dbcspec.compare.ranges import changed_ranges, range_text


def _check(pairing: Pairing) -> Iterator[Change]:
    for signal in changed_ranges(pairing):
        old, new = signal.old, signal.new
        if new.minimum > old.minimum or new.maximum < old.maximum:
            yield signal_change(signal, "range", range_text(old), range_text(new))


PROMISE = Promise(
    "signal-range-not-narrowed",
    "A physical value that was in the range of a signal still is.",
    Class.WIRE,
    Breaks.SENDER,
    _check,
)
