"""No node is new."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, fresh
from typedcan.model.protocol import NOWHERE


def _check(pairing: Pairing) -> Iterator[Change]:
    for node in pairing.added_nodes:
        yield fresh("", node.name, "node", node.name, NOWHERE)


PROMISE = Promise(
    "node-added",
    "A node that is there was there before.",
    Class.ADDITIVE,
    Breaks.NOBODY,
    _check,
)
