"""The rows of behaviour.yaml: checksums, counters, transfers, requests, codes that act, timing."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from typing import ClassVar

from dbcspec.spec.schema import (
    DECIMAL,
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
    pattern,
    whole_number,
    word_of,
)
from typedcan.model.transfer import Counted, Ending, Numbering, Pace
from typedcan.model.transfers.registry import KINDS
from typedcan.model.transfers.text import ENCODINGS

BYTES = pattern(
    "others, or numbers of bytes such as 1~7 or 0 3~7",
    r"others|\d{1,2}(?:~\d{1,2})?(?: \d{1,2}(?:~\d{1,2})?){0,63}",
    str,
)
BESIDE = pattern(
    "a byte, identifier, identifier_reversed or length",
    r"\d{1,3}|0[xX][0-9A-Fa-f]{1,2}|identifier|identifier_reversed|length",
    str,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class ChecksumRow(Record):
    """A checksum: which bytes it covers, and how."""

    IDENTITY: ClassVar[str] = "signal"

    signal: str = key(SIGNAL, "the signal, or message.signal, that carries it", required=True)
    algorithm: str | None = key(
        TEXT,
        "xor, sum, a CRC of the public catalogue by name or parameters, PROFILE_02 or PROFILE_05 of"
        " AUTOSAR E2E, or a name of its own where the standard leaves it open",
    )
    open: str = key(one_of("yes"), "yes where the standard names no algorithm", default="")
    bytes: str | None = key(BYTES, "the bytes covered, in order; others: all but its own")
    before: tuple[str, ...] = key(list_of(BESIDE), "what is covered before them", default=())
    after: tuple[str, ...] = key(list_of(BESIDE), "what is covered after them", default=())
    data_ids: tuple[int, ...] = key(
        list_of(whole_number(0, 0xFFFF)),
        "bytes of which the counter chooses the last one covered; of PROFILE_05 the one data id",
        default=(),
    )
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class CounterRow(Record):
    """An alive counter: it runs 0 to modulus - 1, or through a range."""

    IDENTITY: ClassVar[str] = "signal"

    signal: str = key(SIGNAL, "the signal, or message.signal, that carries it", required=True)
    modulus: int | None = key(INTEGER, "number of values it runs through, from 0")
    range: tuple[Decimal, Decimal] | None = key(RANGE, "first~last value, in place of a modulus")
    step: int = key(INTEGER, "from one value of the range to the next", default=1)
    cite: str = key(TEXT, "where the standard says so", default="")


@dataclass(frozen=True, slots=True, kw_only=True)
class TransferRow(Record):
    """A value that takes several frames, its kind, and what that kind has to know."""

    name: str = key(NAME, "its name", required=True)
    english: str = key(TEXT, "what it carries", default="")
    kind: str = key(
        one_of(*KINDS),
        "what it is (default: readings_by_group where there is a group, else a text)",
        default="",
    )
    messages: tuple[str, ...] = key(list_of(NAME), "messages, in order", required=True)
    items: tuple[str, ...] = key(list_of(SIGNAL), "item signals, in order", required=True)
    frame_number: str = key(SIGNAL, "signal that numbers the frames", default="")
    first_number: int = key(INTEGER, "number of the first frame, 0 or 1", default=1)
    numbering: Numbering = key(
        word_of(Numbering), "what frame numbers count", default=Numbering.THROUGH
    )
    group: str = key(SIGNAL, "signal that tells which group a frame is of", default="")
    first_group: int = key(INTEGER, "number of the first group, 0 or 1", default=1)
    groups: int | None = key(INTEGER, "how many groups, where fixed")
    groups_signal: str = key(SIGNAL, "signal that tells how many groups", default="")
    count: int | None = key(INTEGER, "items in all, where fixed")
    count_signal: str = key(SIGNAL, "signal that tells how many items in all", default="")
    counted: Counted = key(word_of(Counted), "what the count counts", default=Counted.ITEMS)
    counts: tuple[int, ...] = key(list_of(INTEGER), "items of each group, where fixed", default=())
    length: Ending = key(word_of(Ending), "where a text ends", default=Ending.FIXED)
    length_signal: str = key(SIGNAL, "signal that tells how many items are valid", default="")
    fill: int | None = key(INTEGER, "raw value of unused items")
    encoding: str = key(
        one_of(*ENCODINGS),
        "of a text (default: by the codes of its items, or ascii)",
        default="",
    )
    details: tuple[str, ...] = key(
        list_of(SIGNAL), "further signals that belong to the value", default=()
    )
    pace: Pace = key(
        word_of(Pace), "what comes in a period of its messages", default=Pace.ALL_IN_PERIOD
    )
    period: int | None = key(INTEGER, "ms in which all is sent once (default: of its messages)")
    timeout: Decimal | None = key(DECIMAL, "periods in which all frames must have come")
    rounds: int | None = key(INTEGER, "how often in a row the same must come before it counts")
    table: str = key(NAME, "what tables of it are called (default: its name)", default="")
    column: str = key(NAME, "what columns of readings are called (default: its name)", default="")
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
