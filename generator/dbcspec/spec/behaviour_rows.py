"""The rows of behaviour.yaml: checksums, counters, transfers, requests, codes that act, timing."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from typing import ClassVar

from dbcspec.spec.schema import (
    INTEGER,
    NAME,
    RANGE,
    SIGNAL,
    TEXT,
    Record,
    key,
    list_of,
    nested,
    one_of,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChecksumRow(Record):
    """A checksum: which bytes it covers, and how."""

    IDENTITY: ClassVar[str] = "signal"

    signal: str = key(NAME, "the signal that carries it", required=True)
    algorithm: str = key(NAME, "xor, or a name of its own where the standard leaves it open")
    bytes: tuple[Decimal, Decimal] | None = key(RANGE, "first~last byte covered")
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class CounterRow(Record):
    """An alive counter: it runs 0 to modulus - 1."""

    IDENTITY: ClassVar[str] = "signal"

    signal: str = key(NAME, "the signal that carries it", required=True)
    modulus: int | None = key(INTEGER, "number of values it runs through")
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class TransferRow(Record):
    """A value too long for one frame, and how it is split."""

    name: str = key(NAME, "its name", required=True)
    english: str = key(TEXT, "what it carries", default="")
    messages: tuple[str, ...] = key(list_of(NAME), "messages, in order", required=True)
    items: tuple[str, ...] = key(list_of(NAME), "item signals, in order", required=True)
    count: int | None = key(INTEGER, "items in all, where fixed")
    count_signal: str = key(NAME, "signal that tells how many items", default="")
    frame_number: str = key(NAME, "signal that numbers the frames from 1", default="")
    group: str = key(NAME, "signal that tells which group the frame is of", default="")
    length_signal: str = key(NAME, "signal that tells how many items are valid", default="")
    groups_signal: str = key(NAME, "signal that tells how many groups", default="")
    numbering: str = key(
        one_of("within_group", "through"), "what the frame number counts", default="through"
    )
    fill: int | None = key(INTEGER, "raw value of unused items")
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class RequestRow(Record):
    """A signal that asks for messages."""

    IDENTITY: ClassVar[str] = "signal"

    signal: str = key(NAME, "the signal that asks", required=True)
    code: int = key(INTEGER, "the code that asks", required=True)
    withdraw: int | None = key(INTEGER, "the code that no longer asks")
    answers: tuple[str, ...] = key(list_of(NAME), "the messages asked for", required=True)
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class ActsRow(Record):
    """Codes of a signal that make something move, and the code that does not."""

    IDENTITY: ClassVar[str] = "signal"

    signal: str = key(SIGNAL, "the signal, or message.signal", required=True)
    codes: tuple[int, ...] = key(list_of(INTEGER), "the codes that act", required=True)
    safe: int = key(INTEGER, "the code that ends what they begin", required=True)
    kind: str = key(
        one_of("command", "report"),
        "whether they make the receiver act, or only say that something is on",
        default="command",
    )
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class TimingRow(Record):
    """When messages are sent."""

    name: str = key(NAME, "a name for the group", required=True)
    condition: str = key(TEXT, "while or when they are sent, in English", required=True)
    messages: tuple[str, ...] = key(list_of(NAME), "the messages", required=True)
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class Padding(Record):
    """What is sent in bits that carry no signal."""

    reserved: int | None = key(INTEGER, "bit value of printed reserved fields")
    unassigned: int | None = key(INTEGER, "bit value of bits that no field names")
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class Behaviour(Record):
    """behaviour.yaml: what happens on the bus beyond the layout."""

    checksums: tuple[ChecksumRow, ...] = key(list_of(nested(ChecksumRow)), "checksums", default=())
    counters: tuple[CounterRow, ...] = key(list_of(nested(CounterRow)), "counters", default=())
    transfers: tuple[TransferRow, ...] = key(list_of(nested(TransferRow)), "transfers", default=())
    requests: tuple[RequestRow, ...] = key(list_of(nested(RequestRow)), "requests", default=())
    acts: tuple[ActsRow, ...] = key(list_of(nested(ActsRow)), "codes that act", default=())
    timing: tuple[TimingRow, ...] = key(list_of(nested(TimingRow)), "conditions", default=())
    padding: Padding | None = key(nested(Padding), "bits without a signal")
