"""Frames as lines of text or JSON, the same for logs and for a live bus.

A decoded frame in JSON, one object a line:

    {"timestamp": 1.5, "channel": 0, "id": 201, "message": "Motor_Status",
     "signals": {"Motor_State": {"value": 2, "label": "Running"}, "Motor_Alive": null, ...},
     "states": {"Motor_Alive": "Signal Invalid"},
     "faults": [{"kind": "counter", "text": "counter is Signal Invalid, it runs 0 to 14"}]}

Signals have their DBC names. A physical value or a count is a number, in the unit of the DBC; a
code is an object, with a null label where it has none; a character is a string, or the number of
its code where that is no character. A signal that says invalid or abnormal instead of a value is
null, and ``states`` says which; so is a float that is infinite ("inf", "-inf") or no number
("nan"). Signals of a branch that is not in the frame are left out. What is found by its PGN has its
source_address, destination and priority too. A frame of a known message with a wrong length or
checksum has no signals but its bytes and what is wrong:

    {"timestamp": 1.6, "channel": 0, "id": 201, "message": "Motor_Status", "data": "00FF...",
     "fault": {"kind": "checksum", "text": "checksum is 0x00, the bytes make 0xFF"}}

Frames of other protocols are counted only.
"""

from __future__ import annotations

import json
import math
import re
import shutil
import sys
from collections.abc import Collection, Iterator
from typing import Any

import can

from typedcan.commands.shown import Shown
from typedcan.model.j1939 import GLOBAL_ADDRESS
from typedcan.model.numbers import without_noise
from typedcan.model.signal_state import SignalState
from typedcan.shell.console import say
from typedcan.wire.codec import Codec
from typedcan.wire.fields import Field, FloatField, LabelledField
from typedcan.wire.link import Fault, Received
from typedcan.wire.message import Message
from typedcan.wire.receiver import Counts, Receiver

_BETWEEN = "  "
_BETWEEN_PARTS = re.compile(r"(?<=\S)  (?=\S)")
_INDENT = " " * 19

JSON_HELP = (
    "print one JSON object a line: timestamp, channel, id, message, and signals, states, faults,"
    " or data and fault where the frame is refused"
)
"""For the option of the commands that print such lines."""


class Transcript:
    """Prints frames as they come, and counts them.

    Parameters
    ----------
    codec
        Whose messages are shown.
    as_json
        Whether the lines are JSON.
    live
        Whether each line is to be seen at once, also through a pipe.
    shown
        Which messages and faults are printed; all are counted.
    """

    def __init__(
        self, codec: Codec, *, as_json: bool, live: bool = False, shown: Shown | None = None
    ) -> None:
        self._codec = codec
        self._names = max((len(each.NAME) for each in codec.protocol.messages), default=0)
        self._as_json = as_json
        self._live = live
        self._shown = shown or Shown()
        self._columns = terminal_columns()
        # Alive counters run per bus, and a log can have several.
        self._receivers: dict[object, Receiver] = {}
        self._unknown: set[tuple[int, bool]] = set()
        self.messages = 0

    def show(self, frame: can.Message) -> None:
        """Print one frame, unless it is none of the protocol's."""
        taken = self._receiver(frame.channel).take(frame)
        if taken is None:
            if not frame.is_error_frame:
                self._unknown.add((frame.arbitration_id, frame.is_extended_id))
            return
        self.messages += isinstance(taken, Received)
        if not self._shown.has(taken):
            return
        line = json_line(taken) if self._as_json else text_line(taken, self._names)
        say(line if self._as_json else wrapped(line, self._columns), flush=self._live)

    def _receiver(self, channel: object) -> Receiver:
        if channel not in self._receivers:
            self._receivers[channel] = Receiver(self._codec)
        return self._receivers[channel]

    def summary(self) -> str:
        """How many frames there were, and what became of them."""
        counts = [receiver.counts for receiver in self._receivers.values()]
        unknown = sum(each.foreign for each in counts)
        refused = sum(each.length + each.checksum for each in counts)
        return (
            f"frames {self.messages + unknown + refused}, decoded {self.messages},"
            f" unknown {unknown} (identifiers {len(self._unknown)}), {faults_text(counts)}"
        )


def faults_text(counts: Collection[Counts]) -> str:
    """How many faults there were in all, and of which kind."""
    kinds = {
        kind: sum(getattr(each, kind) for each in counts)
        for kind in ("length", "checksum", "counter", "format")
    }
    listed = (f"{kind} {count}" for kind, count in kinds.items() if count or kind != "format")
    return f"faults {sum(kinds.values())} ({', '.join(listed)})"


def text_line(taken: Received[Message] | Fault, width: int = 0) -> str:
    """A frame and what it says, or its fault, for people; names take so many characters.

    Time in s, channel, direction, identifier, bytes, message, values.
    """
    frame = taken.frame
    channel = "-" if frame.channel is None else frame.channel
    name = taken.message.NAME if isinstance(taken, Received) else taken.message
    direction = "Rx" if frame.is_rx else "Tx"
    number = f"{frame.arbitration_id:0{8 if frame.is_extended_id else 3}X}"
    data = frame.data.hex().upper()
    start = (
        f"{frame.timestamp:17.6f}  {channel}  {direction}  {number:>8}  {data:<16}  {name:<{width}}"
    )
    if isinstance(taken, Fault):
        return f"{start}  ! {taken.text}"
    faults = (f"! {fault.text}" for fault in taken.faults)
    return "  ".join((start, *_addresses_text(taken), *values_text(taken.message), *faults))


def terminal_columns() -> int | None:
    """The columns of the terminal that is printed to; None where it is none."""
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else None


def wrapped(line: str, columns: int | None) -> str:
    """A line of parts with two blanks between them, in as many lines as the terminal needs."""
    if columns is None or len(line) <= columns:
        return line
    lines = [""]
    for part in _BETWEEN_PARTS.split(line):
        longer = f"{lines[-1]}{_BETWEEN}{part}" if len(lines) > 1 or lines[-1] else part
        if len(longer) > columns and lines[-1].strip():
            lines.append(f"{_INDENT}{part}"[: max(columns, 1)])
        else:
            lines[-1] = longer
    return "\n".join(lines)


def _addresses_text(received: Received[Message]) -> list[str]:
    """Who sent a message that is found by its PGN, and to whom, if not to all."""
    source, receiver = received.source_address, received.destination
    if source is None or receiver is None:
        return []
    end = "" if receiver == GLOBAL_ADDRESS else f" to 0x{receiver:02X}"
    return [f"from 0x{source:02X}{end}"]


def values_text(message: Message) -> list[str]:
    """The fields of a message as name=value, with label or unit."""
    return [f"{field.name}={field.text(getattr(message, field.name))}" for field in _there(message)]


def json_line(taken: Received[Message] | Fault) -> str:
    """A message or a fault as JSON, in the shape that this module describes."""
    return json.dumps(json_object(taken), allow_nan=False)


def json_object(taken: Received[Message] | Fault) -> dict[str, Any]:
    """The same as plain data."""
    frame = taken.frame
    channel = frame.channel
    line: dict[str, Any] = {
        "timestamp": frame.timestamp if math.isfinite(frame.timestamp) else None,
        "channel": channel if channel is None or isinstance(channel, int) else str(channel),
        "id": frame.arbitration_id,
    }
    if isinstance(taken, Fault):
        line |= {"message": taken.message, "data": frame.data.hex().upper()}
        line |= {"fault": _fault(taken)}
    else:
        message = taken.message
        if taken.source_address is not None:
            names = ("source_address", "destination", "priority")
            line |= {name: getattr(taken, name) for name in names}
        line |= {"message": message.NAME, "signals": _signals(message), "states": _states(message)}
        line |= {"faults": [_fault(fault) for fault in taken.faults]}
    return line


def _fault(fault: Fault) -> dict[str, str]:
    return {"kind": fault.kind, "text": fault.text}


def _there(message: Message) -> Iterator[Field]:
    """The fields of the message, without those of branches that are not there."""
    for field in message.FIELDS.values():
        if field.name not in message.SELECTED or getattr(message, field.name) is not None:
            yield field


def _signals(message: Message) -> dict[str, Any]:
    signals: dict[str, Any] = {}
    for field in _there(message):
        value = getattr(message, field.name)
        if isinstance(value, SignalState):
            signals[field.dbc_name] = None
        elif isinstance(field, LabelledField):
            signals[field.dbc_name] = {"value": int(value), "label": field.labels.get(value)}
        elif isinstance(value, float):
            signals[field.dbc_name] = _number(field, value)
        else:
            signals[field.dbc_name] = value
    return signals


def _number(field: Field, value: float) -> float | None:
    if not math.isfinite(value):  # no number of JSON
        return None
    return value if isinstance(field, FloatField) else without_noise(value)


def _states(message: Message) -> dict[str, str]:
    return {
        field.dbc_name: str(value)
        for field in message.FIELDS.values()
        if isinstance(value := getattr(message, field.name), SignalState)
        or (isinstance(value, float) and not math.isfinite(value))
    }
