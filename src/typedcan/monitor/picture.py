"""All that a monitor knows at one moment; it stays as it is while the bus goes on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from typedcan.monitor.glance import Alarm, Look, Seen
from typedcan.monitor.rows import MessageRow, SignalRow, identifier_text, signal_rows
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol


@dataclass(frozen=True, slots=True)
class Totals:
    """What came in since counting began.

    Parameters
    ----------
    seconds
        How long ago that was.
    frames
        All frames, whatever they were.
    messages
        Those that were messages of the protocol.
    length, checksum, counter, format
        Frames of known messages that were refused for their length or checksum, and messages with
        a wrong counter, or in frames of another format.
    foreign, errors
        Frames of other protocols, and error frames.
    frames_per_second, load
        Over the last two seconds; the load is an estimate, a share of 1, and None where the bit
        rate of the bus is not known.
    """

    seconds: float
    frames: int
    messages: int
    length: int
    checksum: int
    counter: int
    foreign: int
    errors: int
    frames_per_second: float
    load: float | None
    format: int = 0

    @property
    def faults(self) -> int:
        """All faults together."""
        return self.length + self.checksum + self.counter + self.format


@dataclass(frozen=True, slots=True)
class ForeignRow:
    """An identifier that is none of the protocol's, and how many frames had it."""

    frame_id: int
    is_extended: bool
    frames: int
    age: float

    def __str__(self) -> str:
        return identifier_text(self.frame_id, is_extended=self.is_extended)


@dataclass(frozen=True, slots=True)
class Picture:
    """What a `Watch` knows at ``time``, in seconds of its clock.

    ``messages`` has all of the protocol, in its order, ``alarms`` those that are active, of all
    nodes; ``look`` is what the glance shows. ``last`` is what each message said last, ``branches``
    what it said last of each field of a branch.
    """

    time: float
    protocol: Protocol
    totals: Totals
    messages: tuple[MessageRow, ...]
    alarms: tuple[Alarm, ...]
    look: Look
    foreign: tuple[ForeignRow, ...]
    last: Mapping[type[Message], Seen]
    branches: Mapping[type[Message], Mapping[str, Seen]]

    def signals(self, name: str) -> tuple[SignalRow, ...]:
        """The signals of a message; raises `UnknownMessageError`."""
        kind = self.protocol.message(name)
        branches = self.branches.get(kind, {})
        return signal_rows(self.protocol, kind, self.last.get(kind), branches, self.time)

    def as_dict(self) -> dict[str, Any]:
        """The same as JSON has it, without the signals."""
        return {
            "totals": {**asdict(self.totals), "faults": self.totals.faults},
            "messages": [row.as_dict() for row in self.messages],
            **self.look.as_dict(),
            "foreign": [asdict(row) for row in self.foreign],
        }
