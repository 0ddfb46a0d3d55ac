"""Whether a generated package does what cantools does with its DBC, message by message.

Run as a program, in a process of its own, with the folder that the packages lie in, and the name of
a package and its DBC file for each: ``python -m typedcan.trial FOLDER PACKAGE FILE.dbc``. It prints
a fault a line and exits 1 where there is one.

What cantools decodes whole is compared whole. Of other messages, such as those with signals that
overlap or lie outside, and of payloads whose selectors select nothing, each signal is compared for
itself, in a message that has no other.
"""

from __future__ import annotations

import copy
import importlib
import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from enum import IntEnum
from pathlib import Path
from typing import Any

import cantools.database
from cantools.database.can import Database
from cantools.database.can import Message as CantoolsMessage

from typedcan.model import layout
from typedcan.model.errors import one_line
from typedcan.model.protocol import Signal
from typedcan.model.signal_state import SignalState
from typedcan.model.soundness import hidden
from typedcan.payloads import payloads
from typedcan.shell.printing import print_line
from typedcan.wire.codec import Codec
from typedcan.wire.database import Entry, database
from typedcan.wire.errors import EncodeError
from typedcan.wire.fields import ExactField, Field, FloatField, PhysicalField
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

Values = Mapping[str, tuple[Any, Any]]
"""Raw and physical values of the signals that are there, by their names."""


def main(arguments: Sequence[str]) -> int:
    """Try the packages that are named, print what is wrong, and say whether something is."""
    folder, package, file = arguments
    sys.path.insert(0, str(Path(folder).resolve()))
    faults = [*tried(package, Path(file))]
    for line in faults:
        print_line(line)
    return 1 if faults else 0


def tried(package: str, file: Path) -> Iterator[str]:
    """What is wrong with a package, a line each; ``file`` is its DBC."""
    try:
        protocol: Protocol = importlib.import_module(f"{package}.protocol").PROTOCOL
        codec = Codec(protocol)
        entries = database(protocol).by_type
    except Exception as error:  # noqa: BLE001 - generated code may raise anything
        yield f"{package}: cannot be imported: {one_line(error)}"
        return
    theirs = cantools.database.load_file(file, encoding="utf-8", strict=False)
    if not isinstance(theirs, Database):
        raise TypeError(f"{file}: is no CAN database")
    by_id = {(each.is_extended_frame, each.frame_id): each for each in theirs.messages}
    not_written = hidden(protocol.model)
    for kind, entry in entries.items():
        message = by_id.get((kind.EXTENDED, kind.FRAME_ID))
        if kind.NAME in not_written:
            continue
        if message is None:
            yield f"{kind.NAME}: is not in {file.name}"
            continue
        try:
            yield from _Trial(codec, entry, Oracle(kind.MODEL.signals, message)).faults()
        except Exception as error:  # noqa: BLE001
            yield f"{kind.NAME}: {one_line(error)}"


class Oracle:
    """What cantools has in payloads of a message, as far as these signals can be read in them."""

    def __init__(self, signals: Sequence[Signal], message: CantoolsMessage) -> None:
        self._message = message
        self._signals = {signal.name: signal for signal in signals}
        named = {None, *(each.name for each in message.signals)}
        # cantools loses the branches of a selector that has a long name.
        self._is_whole = named.issuperset(each.multiplexer_signal for each in message.signals)

    def values(self, data: bytes, readable: Sequence[str]) -> Values:
        """The values of the readable signals that are there."""
        whole = self._whole(data)
        if whole is None:
            return self._apart(data, readable)
        return {name: pair for name, pair in whole.items() if name in readable}

    def encoded(self, data: bytes) -> bytes | None:
        """What a payload is sent as again; None where cantools does not decode it whole."""
        whole = self._whole(data)
        if whole is None:
            return None
        raw = {name: raw for name, (raw, _) in whole.items()}
        return self._message.encode(raw, scaling=False, strict=False)

    def _whole(self, data: bytes) -> Values | None:
        decode = self._message.decode_simple
        try:
            raw = decode(data, decode_choices=False, scaling=False)
            scaled = decode(data, decode_choices=False)
        except (cantools.database.DecodeError, ValueError, OverflowError):
            return None
        # With scaling cantools selects by the physical value of a selector.
        if not self._is_whole or raw.keys() != scaled.keys():
            return None
        return {name: (raw[name], scaled[name]) for name in raw}

    def _apart(self, data: bytes, readable: Sequence[str]) -> Values:
        values = {name: _alone(self._message, name, data) for name in readable}
        return {name: pair for name, pair in values.items() if self._is_there(name, values)}

    def _is_there(self, name: str, values: Values) -> bool:
        signal = self._signals[name]
        above = signal.multiplexer
        if not above:
            return True
        return values[above][0] in signal.selectors and self._is_there(above, values)


def _alone(message: CantoolsMessage, name: str, data: bytes) -> tuple[Any, Any]:
    """Raw and physical value of a signal, read in a message that has no other."""
    signal = copy.copy(message.get_signal_by_name(name))
    signal.is_multiplexer, signal.multiplexer_ids, signal.multiplexer_signal = False, None, None
    alone = CantoolsMessage(1, "Alone", message.length, [signal], strict=False)
    raw = alone.decode_simple(data, decode_choices=False, scaling=False)
    return raw[name], alone.decode_simple(data, decode_choices=False)[name]


class _Trial:
    """One message beside cantools."""

    def __init__(self, codec: Codec, entry: Entry, oracle: Oracle) -> None:
        self._codec = codec
        self._plain = Codec(codec.protocol, accelerated=False)
        self._entry = entry
        self._kind = entry.type
        self._oracle = oracle
        self._fields = {each.dbc_name: each for each in self._kind.FIELDS.values()}

    def faults(self) -> Iterator[str]:
        """The first thing that is wrong, if any."""
        for data in payloads(self._kind):
            values = self._oracle.values(data, [*self._fields])
            message = self._entry.decode(data)
            fault = self._decoded(message, values) or self._encoded(message, data, values)
            if fault := fault or self._straight(message, data):
                yield f"{self._kind.NAME}: {fault} in {data.hex()}"
                return
        if fault := self._default():
            yield f"{self._kind.NAME}: {fault}"

    def _straight(self, message: Message, data: bytes) -> str:
        """What straight lines do otherwise than cantools' formats and the fields."""
        straight = self._entry.straight
        other = straight.decode(data) if straight else message
        if type(other) is not type(message) or repr(other) != repr(message):
            return f"straight lines make {other!r}, not {message!r}"
        mine, plain = _sent(self._codec, message), _sent(self._plain, message)
        return "" if mine == plain else f"sent as {mine} in straight lines, as {plain} else"

    def _decoded(self, message: Message, values: Values) -> str:
        """What is wrong with the values of the message in a payload."""
        for name, field in self._fields.items():
            value = getattr(message, field.name)
            raw, scaled = values.get(name, (None, None))
            if (value is None) != (raw is None) or not _same(field, value, raw, scaled):
                return f"{field.name} is {value!r}, cantools has {scaled!r}"
        return ""

    def _encoded(self, message: Message, data: bytes, values: Values) -> str:
        """What is wrong with the payload that the message is sent as.

        A value that was received may lie outside of what can be sent.
        """
        there = [self._fields[name] for name in values]
        try:
            sent = self._codec.encode(message)
        except EncodeError as error:
            field = self._kind.FIELDS[error.field]
            # What is rounded may need bits otherwise that another signal shares.
            expected = any(map(_is_rounded, there))
            expected |= _cannot_be_sent(field, *values[field.dbc_name])
            return "" if expected else str(error)
        # Of several codes that say the same state the first is sent.
        other = [
            each
            for each in there
            if _is_rounded(each) or values[each.dbc_name][0] in each.signal.other_invalid_codes
        ]
        mask, rounded = (
            sum({1 << bit for field in fields for bit in layout.bits(field.signal)})
            for fields in (there, other)
        )
        mine, right = (int.from_bytes(each, "little") for each in (sent, data))
        mine ^= layout.filler(self._kind.MODEL)
        if (mine ^ right & mask) & ~rounded:
            return f"sent as {sent.hex()}"
        theirs = self._oracle.encoded(data)
        if theirs is not None and (mine ^ int.from_bytes(theirs, "little")) & mask & ~rounded:
            return f"sent as {sent.hex()}, cantools sends {theirs.hex()}"
        return ""

    def _default(self) -> str:
        """What is wrong with a message that nothing is given of but what must be given."""
        try:
            message = self._kind(**{each.name: _safe(each) for each in _needed(self._kind)})
            data = self._codec.encode(message)
        except EncodeError:
            return ""  # what is sent of no value is outside of the range
        return self._decoded(
            self._entry.decode(data),
            self._oracle.values(data, [*self._fields]),
        )


def _sent(codec: Codec, message: Message) -> str:
    try:
        return codec.encode(message, counter=0).hex()
    except EncodeError as error:
        return str(error)


def _needed(kind: type[Message]) -> list[Field]:
    return [
        each
        for each in kind.FIELDS.values()
        if each.signal.must_be_given and each.name not in kind.SELECTED
    ]


def _safe(field: Field) -> int:
    return field.acting.safe if field.acting else 0


def _same(field: Field, value: object, raw: Any, scaled: Any) -> bool:
    """Whether a value of ours says what cantools' raw and physical values say."""
    if isinstance(value, SignalState) or (raw in field.states and not isinstance(value, float)):
        return field.states.get(raw) is value or isinstance(value, IntEnum | str)
    if isinstance(value, str):
        return bool(ord(value) == raw)
    if isinstance(value, float) and math.isnan(value):
        return math.isnan(scaled)
    return bool(value == scaled)


def _cannot_be_sent(field: Field, raw: float, scaled: float) -> bool:
    """Whether what was received is outside of the range, no number, or one of several."""
    if isinstance(field, ExactField) and isinstance(scaled, float):
        return True
    if isinstance(field, PhysicalField) and not isinstance(field, FloatField):
        least, most = field.signal.sendable
        return not least <= raw <= most
    return not field.minimum <= scaled <= field.maximum


def _is_rounded(field: Field) -> bool:
    """Whether a raw value need not survive the way through its physical value."""
    return isinstance(field, FloatField) and (field.factor != 1 or bool(field.offset))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
