"""A bus keeps its nodes."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, listed, protocol_change
from dbcspec.compare.spec_only import both_are_specs


def _check(pairing: Pairing) -> Iterator[Change]:
    if not both_are_specs(pairing):
        return
    # Of a node that is gone or new as a whole, other promises tell.
    told = {node.name for node in (*pairing.removed_nodes, *pairing.added_nodes)}
    for old, new in pairing.buses:
        if set(pairing.continued(old.nodes)) - told != set(new.nodes) - told:
            yield protocol_change(new.name, "nodes", listed(old.nodes), listed(new.nodes))


PROMISE = Promise(
    "bus-nodes-same",
    "The same nodes are on a bus.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
)
