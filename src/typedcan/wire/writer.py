"""The payloads of one message to be sent: with its checksum and its alive counter."""

from __future__ import annotations

from collections.abc import Mapping

from typedcan.model.seal import Seal
from typedcan.wire.acting import safe_codes
from typedcan.wire.database import Entry
from typedcan.wire.errors import EncodeError
from typedcan.wire.message import Message


class Writer:
    """Makes the payloads of one message.

    Parameters
    ----------
    entry
        The message.
    seal
        What makes the checksum.
    accelerated
        Whether a generated function may put the bits together.
    """

    __slots__ = ("_checksum", "_counter", "_counts", "_entry", "_first", "_seal", "_straight")

    def __init__(self, entry: Entry, seal: Seal | None, *, accelerated: bool) -> None:
        kind = entry.type
        self._entry = entry
        self._seal = seal
        self._straight = entry.straight.encode if accelerated and entry.straight else None
        self._checksum = kind.field_of(kind.CHECKSUM.signal) if kind.CHECKSUM else None
        self._counter = kind.field_of(kind.COUNTER.signal) if kind.COUNTER else None
        self._first = kind.COUNTER.first if kind.COUNTER else 0
        self._counts = range(1 << self._counter.length if self._counter else 0)

    def payload(
        self,
        message: Message,
        counter: int | None = None,
        *,
        renew: bool = False,
        safe: Mapping[str, int] | None = None,
    ) -> bytes:
        """The payload; ``safe`` is what stands in for safe codes; see `Codec.encode`."""
        checksum = self._checksum
        given = checksum is not None and getattr(message, checksum.name) is not None
        if self._counter is None:
            counter = None
        elif counter is None and self._first and getattr(message, self._counter.name) is None:
            counter = self._first
        elif counter is not None and counter not in self._counts:
            kind, problem = self._entry.type, f"has no room for {counter}"
            raise EncodeError(kind.NAME, self._counter.name, counter, problem)
        renewed = given and renew
        straight = self._straight
        if straight and safe is None and not renewed:
            data = straight(message, counter)
        else:
            data = self._packed(message, counter, renewed=renewed, safe=safe)
        return data if checksum is None or (given and not renew) else self._sealed(data)

    def _packed(
        self,
        message: Message,
        counter: int | None,
        *,
        renewed: bool,
        safe: Mapping[str, int] | None,
    ) -> bytes:
        """The payload by cantools' formats, without a checksum that is to be made anew."""
        raw = message.to_raw()
        if safe is not None:
            raw.update(safe_codes(type(message)))
            raw.update(safe)
        if counter is not None and self._counter:
            raw[self._counter.dbc_name] = counter
        if renewed and self._checksum:
            raw[self._checksum.dbc_name] = 0
        try:
            return self._entry.packer.pack(raw)
        except ValueError as error:
            kind = self._entry.type
            field = kind.field_of(str(error)).name
            problem = "shares bits with another signal, whose value needs them otherwise"
            raise EncodeError(kind.NAME, field, getattr(message, field), problem) from None

    def _sealed(self, data: bytes) -> bytes:
        """The payload with its checksum, or as it is where the standard leaves that open."""
        if self._seal:
            return self._seal.filled(data)
        kind = self._entry.type
        if kind.CHECKSUM and self._checksum and not kind.CHECKSUM.is_open:
            problem = (
                f"nothing here computes {kind.CHECKSUM.algorithm!r}: give Codec that algorithm"
            )
            raise EncodeError(kind.NAME, self._checksum.name, None, problem)
        return data
