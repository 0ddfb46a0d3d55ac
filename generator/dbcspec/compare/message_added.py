"""No message is new."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, fresh, hex_id


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.added:
        yield fresh(message.name, message.name, "message", hex_id(message.frame_id), message.where)


PROMISE = Promise(
    "message-added",
    "A message that is there was there before.",
    Class.ADDITIVE,
    Breaks.NOBODY,
    _check,
)
