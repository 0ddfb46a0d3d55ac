"""No bus is new."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, fresh
from dbcspec.compare.spec_only import both_are_specs
from typedcan.model.protocol import NOWHERE


def _check(pairing: Pairing) -> Iterator[Change]:
    # A DBC is one bus, under a name of its own.
    if both_are_specs(pairing):
        for bus in pairing.added_buses:
            yield fresh("", bus.name, "bus", bus.name, NOWHERE)


PROMISE = Promise(
    "bus-added",
    "A bus that is there was there before.",
    Class.ADDITIVE,
    Breaks.NOBODY,
    _check,
)
