"""A codec that speaks a chosen edition with the message classes that a program has."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache, cached_property

import can

from typedcan.dynamic import typed_protocol
from typedcan.model.checksums.registry import Given
from typedcan.model.variants import choose
from typedcan.spoken.words import Same, Words
from typedcan.wire.codec import Codec
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol
from typedcan.wire.reader import Reader


@cache
def spoken(own: Protocol, names: tuple[str, ...]) -> Protocol:
    """The protocol in the readings and the edition of these names, with classes of its own.

    Raises `ReadError` as `choose`.
    """
    return typed_protocol(choose(own.model, names)) if names else own


class SpokenCodec(Codec):
    """Encodes and decodes the messages of a protocol as a chosen edition has them.

    Messages of the own classes are said in the edition, and what is heard comes in the own classes;
    messages that only the edition has come in classes of its own, and those may be sent too.

    Parameters
    ----------
    own
        The protocol with the classes of the program.
    names
        The edition and the readings, as `choose` takes them; raises `ReadError`.
    algorithms
        As `Codec` has them.

    Attributes
    ----------
    words
        What turns the ones into the others.
    """

    def __init__(
        self, own: Protocol, names: Iterable[str], algorithms: Given | None = None
    ) -> None:
        super().__init__(spoken(own, tuple(names)), algorithms)
        self.words = Words(own, self.protocol)
        self._bare = Codec(self.protocol, algorithms)

    @property
    def bare(self) -> Codec:
        """The codec of the classes of the edition."""
        return self._bare

    def said(self, message: Message) -> Message:
        """The message as the edition has it; raises `EncodeError` for what it cannot say."""
        return self.words.said(message)

    def kind(self, frame_id: int, *, extended: bool) -> type[Message] | None:
        """See `Codec.kind`; the own class where there is one."""
        found = super().kind(frame_id, extended=extended)
        return self.words.own(found) if found else None

    def encode(
        self,
        message: Message,
        *,
        counter: int | None = None,
        renew: bool = False,
        safe: bool = False,
    ) -> bytes:
        """See `Codec.encode`."""
        return super().encode(self.said(message), counter=counter, renew=renew, safe=safe)

    def frame(
        self,
        message: Message,
        *,
        counter: int | None = None,
        safe: bool = False,
        source_address: int | None = None,
        destination: int | None = None,
    ) -> can.Message:
        """See `Codec.frame`."""
        return super().frame(
            self.said(message),
            counter=counter,
            safe=safe,
            source_address=source_address,
            destination=destination,
        )

    @cached_property
    def _by_type(self) -> Mapping[type[Message], Reader]:
        """The readers by both classes; what they read comes in the own one."""
        readers = dict(super()._by_type)
        for kind, reader in tuple(readers.items()):
            own = self.words.own(kind)
            if own is not kind:
                reader.decode = self._hearing(reader.decode)
                reader.kind = own
                readers[own] = reader
        return readers

    def _hearing(self, decode: Callable[[bytes], Message]) -> Callable[[bytes], Message]:
        hear = self.words.heard
        return lambda data: hear(decode(data))


def words_of(codec: Codec) -> Same:
    """What turns messages of a program into what a codec speaks, and back."""
    return codec.words if isinstance(codec, SpokenCodec) else Same()
