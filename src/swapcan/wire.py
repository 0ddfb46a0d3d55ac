"""Typed messages of this standard: what `typedcan.wire` has, with its protocol set."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import resources
from typing import Any, overload

import can

from swapcan._generated.protocol import PROTOCOL
from typedcan.model.checksums.registry import Given
from typedcan.model.errors import TypedcanError
from typedcan.wire import codec, link, receiver
from typedcan.wire import database as databases
from typedcan.wire.message import Message, MessageT
from typedcan.wire.protocol import Protocol

SwapcanError = TypedcanError
"""Base of all errors that are raised on purpose."""


class Codec(codec.Codec):
    """Encodes and decodes the messages of the standard.

    Parameters
    ----------
    algorithms
        What computes the checksums that the standard leaves open, by name, for example
        ``{"BMS_CRC": my_crc}``: a function from the covered bytes to an int, or the name of a
        known one, such as "CRC-8/SAE-J1850". Without one that checksum is sent as 0 and not
        verified.
    protocol
        Another protocol whose package `dbcspec generate` wrote.
    accelerated
        Whether generated functions may move the bits; cantools' formats do the same.
    """

    def __init__(
        self,
        algorithms: Given | None = None,
        protocol: Protocol = PROTOCOL,
        *,
        accelerated: bool = True,
    ) -> None:
        super().__init__(protocol, algorithms, accelerated=accelerated)


class Link(link.Link):
    """One node's typed messages of the standard; see `typedcan.wire.link.Link`.

    ``edition`` and ``readings`` choose what is spoken on the bus where no codec is given, as
    `codec_for` has them.
    """

    def __init__(
        self,
        bus: can.BusABC,
        *,
        codec: codec.Codec | None = None,
        on_fault: Callable[[receiver.Fault], None] | None = None,
        edition: str = "",
        readings: Iterable[str] = (),
    ) -> None:
        super().__init__(bus, codec or codec_for(edition, readings), on_fault=on_fault)


class Receiver(receiver.Receiver):
    """Decodes the frames of one bus, checks and counts them."""

    def __init__(self, codec: codec.Codec | None = None) -> None:
        super().__init__(codec or _CODEC)


_CODEC = Codec()


def codec_for(
    edition: str = "", readings: Iterable[str] = (), algorithms: Given | None = None
) -> codec.Codec:
    """What speaks the standard in an edition and readings, with the classes of `swapcan.messages`.

    ``codec_for("v4.6")`` speaks as the trucks of that edition do, ``codec_for(readings=["E50b"])``
    takes one erratum in another way; see `typedcan.spoken.codec.SpokenCodec`. Raises `ReadError`
    for a name that there is not, and as `Codec`.
    """
    names = (*([edition] if edition else []), *readings)
    if not names:
        return Codec(algorithms) if algorithms else _CODEC
    from typedcan.spoken.codec import SpokenCodec  # where nothing is chosen nothing of it is read

    return SpokenCodec(PROTOCOL, names, algorithms)


def encode(message: Message, *, counter: int | None = None) -> bytes:
    """As `Codec.encode`, with the algorithms that the standard states."""
    return _CODEC.encode(message, counter=counter)


@overload
def decode(frame_id: int, data: bytes, *, verify: bool = True) -> Message: ...
@overload
def decode(frame_id: type[MessageT], data: bytes, *, verify: bool = True) -> MessageT: ...
def decode(frame_id: Any, data: bytes, *, verify: bool = True) -> Any:
    """As `Codec.decode`, with the algorithms that the standard states."""
    return _CODEC.decode(frame_id, data, verify=verify)


def dbc_text() -> str:
    """The text of the DBC of the standard."""
    package = resources.files("swapcan._generated")
    return package.joinpath(f"{PROTOCOL.name}.dbc").read_text("ascii")


def message_type(name: str) -> type[Message]:
    """The message class of that name; raises `UnknownMessageError`."""
    return PROTOCOL.message(name)


def database(protocol: Protocol = PROTOCOL) -> databases.Database:
    """What packs and decodes each message."""
    return databases.database(protocol)
