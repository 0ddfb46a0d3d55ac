"""The waist of the toolchain: one frozen description of a CAN protocol.

Everything that reads a protocol ends here, everything that lints, compares or emits one starts
here. Start bits are counted as DBC files count them: bit 0 is the least significant bit of byte
0, an Intel signal starts at its least and a Motorola signal at its most significant bit.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property

from typedcan.model.canonical import canonical
from typedcan.model.errors import Location
from typedcan.model.extras import (
    Attribute,
    AttributeDefinition,
    EnvironmentVariable,
    Relation,
    SignalGroup,
)
from typedcan.model.protection import Checksum, Counter
from typedcan.model.signal import NOWHERE as NOWHERE
from typedcan.model.signal import ByteOrder as ByteOrder
from typedcan.model.signal import Code as Code
from typedcan.model.signal import Signal as Signal
from typedcan.model.signal import ValueTable as ValueTable
from typedcan.model.transfer import Transfer

LONGEST_CLASSIC = 8
"""Bytes that a frame of classic CAN carries."""

FD_LENGTHS = (*range(9), 12, 16, 20, 24, 32, 48, 64)
"""Bytes that a frame of CAN FD carries."""


class SendType(Enum):
    """When a message is sent, as GenMsgSendType numbers it."""

    CYCLIC = 0
    IF_ACTIVE = 7
    EVENT = 8


class Aspect(Enum):
    """What a protocol says beyond its bits; a DBC file cannot carry all of it."""

    PERIODS = "periods and send types"
    START_VALUES = "start values"
    COMMENTS = "titles and comments"
    REFERENCES = "places in the standard and errata"
    ADDRESSES = "node addresses"
    VALUE_TABLE_NAMES = "names of value tables"
    PYTHON_NAMES = "field names of generated code"
    PROTECTION = "checksums and counters"
    TRANSFERS = "transfers and requests"
    ACTS = "codes that act"
    FRAME_FORMATS = "classic CAN or CAN FD, and what is found by its PGN"
    ATTRIBUTES = "attributes of any name, signal groups, environment variables"


@dataclass(frozen=True, slots=True, kw_only=True)
class ReservedBits:
    """Bits of a message that are printed as reserved, and what each of them is sent as."""

    start: int
    length: int
    byte_order: ByteOrder = ByteOrder.INTEL
    value: int = 0
    reference: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Message:
    """What one identifier carries. ``period`` is in ms, None where it is sent on events only.

    With ``is_fd`` its frames are CAN FD frames, whatever their length, and with ``bit_rate_switch``
    their payload has the second bit rate. ``other_senders`` may send it beside ``sender``. With
    ``by_pgn`` any frame with the PGN of its 29-bit identifier is one, as SAE J1939 has it, whatever
    the priority, the source address and, where there is one, the destination.
    """

    name: str
    title: str = ""
    english: str = ""
    frame_id: int
    extended: bool = True
    length: int
    is_fd: bool = False
    bit_rate_switch: bool = False
    by_pgn: bool = False
    sender: str
    other_senders: tuple[str, ...] = ()
    period: int | None = None
    send_type: SendType = SendType.EVENT
    condition: str = ""
    signals: tuple[Signal, ...] = ()
    checksum: Checksum | None = None
    counter: Counter | None = None
    reserved: tuple[ReservedBits, ...] = ()
    groups: tuple[SignalGroup, ...] = ()
    attributes: tuple[Attribute, ...] = ()
    relations: tuple[Relation, ...] = ()
    reference: str = ""
    errata: tuple[str, ...] = ()
    where: Location = field(default=NOWHERE, compare=False)

    def comment(self, *, english: bool = True) -> str:
        """What it carries and when it is sent, as comments have it."""
        if not english or not self.condition:
            return self.english if english else self.title
        when = f", every {self.period} ms" if self.period else ""
        return f"{self.english}. Sent {self.condition}{when}."

    def signal(self, name: str) -> Signal:
        """The signal of that name; raises `KeyError`."""
        by_name = {signal.name: signal for signal in reversed(self.signals)}
        return by_name[name]

    @property
    def senders(self) -> tuple[str, ...]:
        """Who may send it, in order."""
        return tuple(filter(None, (self.sender, *self.other_senders)))

    @property
    def frame_kind(self) -> str:
        """Classic CAN or CAN FD, and whether its payload has the second bit rate, for people."""
        kind = "CAN FD" if self.is_fd else "classic CAN"
        return f"{kind}, second bit rate" if self.bit_rate_switch else kind

    @property
    def frame_length(self) -> int:
        """The bytes of its frames: those of CAN FD frames are filled up to a length that it has."""
        longer = (each for each in FD_LENGTHS if each >= self.length)
        return next(longer, self.length) if self.is_fd else self.length

    @property
    def receivers(self) -> tuple[str, ...]:
        """Who receives any of its signals, in order of appearance."""
        return tuple(dict.fromkeys(name for sig in self.signals for name in sig.receivers))


@dataclass(frozen=True, slots=True, kw_only=True)
class Node:
    """A participant; ``address`` is its J1939 source address."""

    name: str
    title: str = ""
    english: str = ""
    address: int | None = None
    other_addresses: tuple[int, ...] = ()
    attributes: tuple[Attribute, ...] = ()
    errata: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Bus:
    """A physical bus: its bit rate in bit/s and who is on it."""

    name: str
    title: str = ""
    english: str = ""
    bit_rate: int
    nodes: tuple[str, ...]
    errata: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Alternative:
    """Another reading of the same place, which a run can choose by its id, and who reads it so."""

    id: str
    reading: str
    because: str
    source: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """The protocol in another reading or edition, as what it changes.

    ``name`` chooses it: the id of an alternative or the name of an edition. ``english``, ``title``,
    ``source``, ``date`` and ``warnings`` are for people; an edition takes the ``readings``.
    ``changes`` is text that `typedcan.model.variants` makes and reads.
    """

    name: str
    is_edition: bool = False
    english: str
    title: str = ""
    source: str = ""
    date: str = ""
    warnings: tuple[str, ...] = ()
    readings: tuple[str, ...] = ()
    changes: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Erratum:
    """A reading that differs from print, for people, with the other readings of its place."""

    id: str
    kind: str
    place: str
    printed: str
    reading: str
    because: str
    source: str = field(default="", compare=False)
    alternatives: tuple[Alternative, ...] = field(default=(), compare=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """A code of a signal that asks for messages, and the code that withdraws the request."""

    signal: str
    code: int
    withdraw: int | None
    answers: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Protocol:
    """A whole protocol, every correction applied.

    ``carries`` tells what its source could say at all, so that a comparison does not take silence
    for a difference; ``made_from`` is the digest of the protocol that it says it was made from.
    ``chosen`` names the edition and the readings where they are not the usual ones, as
    ``v4.6+E50b``; ``variants`` are those that can be chosen at run time. ``version`` is the text of
    a database's VERSION; ``definitions`` are those of attributes that only its own tools know.
    """

    name: str
    number: str = ""
    title: str = ""
    english: str = ""
    edition: str = ""
    chosen: str = ""
    nodes: tuple[Node, ...] = ()
    buses: tuple[Bus, ...] = ()
    messages: tuple[Message, ...] = ()
    value_tables: tuple[ValueTable, ...] = ()
    transfers: tuple[Transfer, ...] = ()
    requests: tuple[Request, ...] = ()
    errata: tuple[Erratum, ...] = ()
    version: str = ""
    definitions: tuple[AttributeDefinition, ...] = ()
    attributes: tuple[Attribute, ...] = ()
    variables: tuple[EnvironmentVariable, ...] = ()
    carries: frozenset[Aspect] = field(default=frozenset(Aspect), compare=False)
    made_from: str = field(default="", compare=False)
    variants: tuple[Variant, ...] = field(default=(), compare=False)

    def signals(self) -> Iterator[tuple[Message, Signal]]:
        """Every signal with its message, in order."""
        return ((message, signal) for message in self.messages for signal in message.signals)

    @property
    def frame_format(self) -> str:
        """The word of VFrameFormat that says most of its messages in classic CAN frames."""
        if any(message.by_pgn for message in self.messages):
            return "J1939PG"
        extended = any(message.extended for message in self.messages) or not self.messages
        return "ExtendedCAN" if extended else "StandardCAN"

    def message(self, name: str) -> Message:
        """The message of that name; raises `KeyError`."""
        return {message.name: message for message in reversed(self.messages)}[name]

    @cached_property
    def digest(self) -> str:
        """16 hexadecimal digits that change whenever anything but a location changes."""
        return hashlib.sha256(canonical(self).encode()).hexdigest()[:16]
