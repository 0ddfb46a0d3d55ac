"""Whether a generated package does what cantools does with its DBC, message by message.

Run as a program, in a process of its own, with the folder that the packages lie in, and the name of
a package and its DBC file for each: ``python -m typedcan.trial FOLDER PACKAGE FILE.dbc``. It prints
a fault a line and exits 1 where there is one; else it prints the messages of which nothing can be
said, as cantools decodes none of their payloads.
"""

from __future__ import annotations

import importlib
import math
import random
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
from typedcan.shell.printing import print_line
from typedcan.wire.codec import Codec
from typedcan.wire.database import Entry, database
from typedcan.wire.errors import EncodeError
from typedcan.wire.fields import Field, FloatField, PhysicalField
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_PAYLOADS = 6
"""Random payloads that each message is tried with, beside those of all 0 and all 1."""

_BRANCHES = 100
"""Signals of branches that are tried, of a message."""

_EXACT = 1 << 53

Raw = Mapping[str, int | float]


def main(arguments: Sequence[str]) -> int:
    """Try the packages that are named, print what is wrong, and say whether something is."""
    folder, package, file = arguments
    sys.path.insert(0, str(Path(folder).resolve()))
    untold: list[str] = []
    faults = [*tried(package, Path(file), untold)]
    for line in faults or untold:
        print_line(line)
    return 1 if faults else 0


def tried(package: str, file: Path, untold: list[str]) -> Iterator[str]:
    """What is wrong with a package, a line each; ``file`` is its DBC.

    ``untold`` gets the messages of which cantools decodes nothing, such as those with signals that
    overlap or lie outside: nothing can be said of them.
    """
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
    for kind, entry in entries.items():
        message = by_id.get((kind.EXTENDED, kind.FRAME_ID))
        if message is None:
            yield f"{kind.NAME}: is not in {file.name}"
            continue
        try:
            trial = _Trial(codec, entry, message)
            yield from trial.faults()
            if not trial.compared:
                untold.append(kind.NAME)
        except Exception as error:  # noqa: BLE001
            yield f"{kind.NAME}: {one_line(error)}"


class _Trial:
    """One message beside cantools."""

    def __init__(self, codec: Codec, entry: Entry, theirs: CantoolsMessage) -> None:
        self._codec = codec
        self._entry = entry
        self._kind = entry.type
        self._theirs = theirs
        self.compared = False
        self._fields = {each.dbc_name: each for each in self._kind.FIELDS.values()}

    def faults(self) -> Iterator[str]:
        """The first thing that is wrong, if any."""
        names = {None, *(each.name for each in self._theirs.signals)}
        if not names.issuperset(each.multiplexer_signal for each in self._theirs.signals):
            return  # cantools loses the branches of a selector that has a long name
        for data in self._payloads():
            raw = self._raw(data)
            self.compared |= raw is not None
            if raw is not None and (fault := self._decoded(data, raw) or self._encoded(data, raw)):
                yield f"{self._kind.NAME}: {fault}"
                return
        if fault := self._default():
            yield f"{self._kind.NAME}: {fault}"

    def _payloads(self) -> Iterator[bytes]:
        length = self._kind.LENGTH
        yield bytes(length)
        yield b"\xff" * length
        source = random.Random(self._kind.NAME)
        for _ in range(_PAYLOADS if length else 0):
            yield source.randbytes(length)
        for selected in self._branches():
            yield _with_codes(source.randbytes(length), selected)

    def _branches(self) -> Iterator[dict[Signal, int]]:
        """Values of the selectors with which each branch is there, others at one that they know."""
        by_name = {signal.name: signal for signal in self._kind.MODEL.signals}
        within = [each for each in by_name.values() if each.multiplexer in by_name]
        usual = {by_name[each.multiplexer]: each.selectors[0] for each in reversed(within)}
        for signal in within[:_BRANCHES]:
            selected, inner = dict(usual), signal
            for _ in within:  # no deeper than that
                if inner.multiplexer in by_name:
                    selected[by_name[inner.multiplexer]] = inner.selectors[0]
                    inner = by_name[inner.multiplexer]
            yield selected

    def _raw(self, data: bytes) -> Raw | None:
        """The raw values by cantools; None where it knows no such branch or a float is none."""
        try:
            raw: Any = self._theirs.decode_simple(data, decode_choices=False, scaling=False)
        except cantools.database.DecodeError:
            return None
        return None if any(map(math.isnan, raw.values())) else raw

    def _decoded(self, data: bytes, raw: Raw) -> str:
        """What is wrong with the values of the message in a payload."""
        message = self._entry.decode(self._entry.packer.unpack(data))
        scaled: Any = self._theirs.decode_simple(data, decode_choices=False)
        for field in self._kind.FIELDS.values():
            name, value = field.dbc_name, getattr(message, field.name)
            if (value is None) != (name not in raw):
                return f"{field.name} is {value!r}, cantools has {raw.get(name)!r}"
            if value is not None and not _same(field, value, raw[name], scaled[name]):
                return f"{field.name} is {value!r}, cantools has {scaled[name]!r}"
        return ""

    def _encoded(self, data: bytes, raw: Raw) -> str:
        """What is wrong with the payload that the message is sent as.

        A value that was received may lie outside of what can be sent.
        """
        message = self._entry.decode(self._entry.packer.unpack(data))
        try:
            mine = self._codec.encode(message)
        except EncodeError:
            return ""
        theirs = self._theirs.encode(dict(raw), scaling=False, strict=False)
        again = self._raw(mine) or {}
        exact = [name for name in raw if not self._is_rounded(name, raw[name])]
        if mine == theirs or (len(exact) < len(raw) and all(again[n] == raw[n] for n in exact)):
            return ""
        return f"sent as {mine.hex()}, cantools sends {theirs.hex()}"

    def _is_rounded(self, name: str, raw: float) -> bool:
        """Whether a raw value need not survive the way through its physical value.

        A float has no room for all integers of over 53 bits, nor for what is tiny beside an offset.
        """
        field = self._fields[name]
        if isinstance(field, FloatField):
            return field.factor != 1 or bool(field.offset)
        return isinstance(field, PhysicalField) and abs(raw) >= _EXACT

    def _default(self) -> str:
        """What is wrong with a message that nothing is given of but what must be given."""
        try:
            message = self._kind(**{each.name: _safe(each) for each in _needed(self._kind)})
            data = self._codec.encode(message)
        except EncodeError:
            return ""  # what is sent of no value is outside of the range
        raw = self._raw(data)
        return self._decoded(data, raw) if raw is not None else ""


def _with_codes(data: bytes, codes: Mapping[Signal, int]) -> bytes:
    """A payload with other raw values of some signals."""
    number = int.from_bytes(data, "little")
    for signal, code in codes.items():
        for place, bit in enumerate(layout.bits(signal)):
            number = number & ~(1 << bit) | (code >> place & 1) << bit
    room = (1 << 8 * len(data)) - 1
    return (number & room).to_bytes(len(data), "little")


def _needed(kind: type[Message]) -> list[Field]:
    return [each for each in kind.FIELDS.values() if each.signal.must_be_given]


def _safe(field: Field) -> int:
    return field.acting.safe if field.acting else 0


def _same(field: Field, value: object, raw: float, scaled: float) -> bool:
    """Whether a value of ours says what cantools' raw and physical values say."""
    if isinstance(value, SignalState) or raw in field.states:
        return field.states.get(int(raw)) is value or isinstance(value, IntEnum | str)
    if isinstance(value, str):
        return ord(value) == raw
    if isinstance(value, IntEnum):
        return value.value == raw
    if isinstance(value, int):
        return value == raw
    return isinstance(value, float) and math.isclose(value, scaled, rel_tol=1e-9, abs_tol=1e-12)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
