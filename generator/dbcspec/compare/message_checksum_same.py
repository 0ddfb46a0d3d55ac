"""A message keeps its checksum."""

from __future__ import annotations

from collections.abc import Iterator

from dbcspec.compare.pairing import Pairing
from dbcspec.compare.promise import Breaks, Change, Class, Promise, message_change
from dbcspec.compare.protection import protection_follows
from typedcan.model.protection import Checksum
from typedcan.model.protocol import Aspect


def _check(pairing: Pairing) -> Iterator[Change]:
    for message in pairing.messages:
        old, new = message.old.checksum, message.new.checksum
        if old != new and not protection_follows(message, old, new):
            yield message_change(message, "checksum", _text(old), _text(new))


def _text(checksum: Checksum | None) -> str:
    return f"{checksum} in {checksum.signal}" if checksum else ""


PROMISE = Promise(
    "message-checksum-same",
    "A message is protected by the same checksum over the same bytes.",
    Class.WIRE,
    Breaks.BOTH,
    _check,
    needs=Aspect.PROTECTION,
)
