"""A message stays."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, gone, hex_id


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.removed:
        yield gone(message.name, message.name, "message", hex_id(message.frame_id), message.where)


PROMISE = Promise(
    "message-present",
    "A message that was there still is.",
    Class.WIRE,
    Breaks.RECEIVER,
    _check,
)
