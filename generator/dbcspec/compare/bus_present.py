"""A bus stays."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, gone
from dbcspec.compare.spec_only import both_are_specs
from typedcan.model.protocol import NOWHERE


def _check(pairing: Pairing) -> Iterator[Change]:
    # A DBC is one bus, under a name of its own.
    if both_are_specs(pairing):
        for bus in pairing.removed_buses:
            yield gone("", bus.name, "bus", bus.name, NOWHERE)


PROMISE = Promise(
    "bus-present",
    "A bus that was there still is.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
