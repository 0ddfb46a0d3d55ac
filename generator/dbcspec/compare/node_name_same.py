"""A node keeps its name."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change


def _check(pairing: Pairing) -> Iterator[Change]:
    for old, new in pairing.nodes:
        if old.name != new.name:
            yield protocol_change(new.name, "name of node", old.name, new.name)


PROMISE = Promise(
    "node-name-same",
    "A node with the same part on the bus is called the same in code.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
)
