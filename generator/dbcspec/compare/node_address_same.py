"""A node keeps its addresses."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, listed, protocol_change
from dbcspec.compare.spec_only import both_are_specs
from typedcan.model.protocol import Aspect, Node


def _check(pairing: Pairing) -> Iterator[Change]:
    for old, new in pairing.nodes:
        # Further addresses are nothing that a DBC could say.
        further = both_are_specs(pairing) and old.other_addresses != new.other_addresses
        if further or old.address != new.address:
            yield protocol_change(new.name, "address", _text(old), _text(new))


def _text(node: Node) -> str:
    first = "none" if node.address is None else f"0x{node.address:02X}"
    return listed((first, *(f"0x{address:02X}" for address in node.other_addresses)))


PROMISE = Promise(
    "node-address-same",
    "A node keeps its J1939 source addresses.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
    needs=Aspect.ADDRESSES,
)
