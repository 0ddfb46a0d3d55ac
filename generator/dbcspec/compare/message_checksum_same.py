"""A message keeps its checksum."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, message_change
from dbcspec.compare.protection import protection_follows
from typedcan.model.protocol import Aspect, Checksum


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        old, new = message.old.checksum, message.new.checksum
        if old != new and not protection_follows(message, old, new):
            yield message_change(message, "checksum", _text(old), _text(new))


def _text(checksum: Checksum | None) -> str:
    if checksum is None:
        return ""
    covered = f"bytes {checksum.first_byte} to {checksum.last_byte}"
    return f"{checksum.algorithm} of {covered} in {checksum.signal}"


PROMISE = Promise(
    "message-checksum-same",
    "A message is protected by the same checksum over the same bytes.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
    needs=Aspect.PROTECTION,
)
