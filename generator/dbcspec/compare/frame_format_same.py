"""Identifiers are matched whole or by parameter group, as before."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, protocol_change

_BY_GROUP = "J1939PG"


def _check(pairing: Pairing) -> Iterator[Change]:
    # Standard or extended is a promise of its own.
    old, new = pairing.old.frame_format, pairing.new.frame_format
    if (old == _BY_GROUP) != (new == _BY_GROUP):
        yield protocol_change("messages", "frame format", old, new)


PROMISE = Promise(
    "frame-format-same",
    "Tools match identifiers whole, or by J1939 parameter group, as before.",
    Class.SOURCE,
    Breaks.BOTH,
    _check,
)
