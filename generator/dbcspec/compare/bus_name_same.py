"""A bus keeps its name."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change
from dbcspec.compare.spec_only import both_are_specs


def _check(pairing: Pairing) -> Iterator[Change]:
    # Elsewhere a bus is called as its file is.
    if both_are_specs(pairing):
        for old, new in pairing.buses:
            if old.name != new.name:
                yield protocol_change(new.name, "name of bus", old.name, new.name)


PROMISE = Promise(
    "bus-name-same",
    "A bus of the same nodes is called the same in code and file names.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
)
