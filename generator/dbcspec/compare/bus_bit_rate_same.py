"""A bus keeps its bit rate."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, listed, protocol_change
from dbcspec.compare.spec_only import both_are_specs


def _check(pairing: Pairing) -> Iterator[Change]:
    for before, after in pairing.buses:
        if before.bit_rate != after.bit_rate:
            yield _change(after.name, {before.bit_rate}, {after.bit_rate})
    if not both_are_specs(pairing):
        # A file that has one bus for all of a spec can still say the bit rate.
        old = {bus.bit_rate for bus in pairing.removed_buses}
        new = {bus.bit_rate for bus in pairing.added_buses}
        if old and new and old != new:
            yield _change(pairing.added_buses[0].name, old, new)


def _change(bus: str, old: set[int], new: set[int]) -> Change:
    return protocol_change(bus, "bit rate", _text(old), _text(new))


def _text(rates: set[int]) -> str:
    return listed(f"{rate} bit/s" for rate in sorted(rates))


PROMISE = Promise(
    "bus-bit-rate-same",
    "A bus runs at the same bit rate.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
