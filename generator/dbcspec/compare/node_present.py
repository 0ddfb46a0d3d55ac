"""A node stays."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, gone
from typedcan.model.protocol import NOWHERE


def _check(pairing: Pairing) -> Iterator[Change]:
    for node in pairing.removed_nodes:
        yield gone("", node.name, "node", node.name, NOWHERE)


PROMISE = Promise(
    "node-present",
    "A node that was there still is.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
