"""Databases and frames for the tests of the decoder, and what cantools makes of them."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
from functools import cache
from random import Random
from typing import Any

import numpy as np
from cantools.database import DecodeError
from cantools.database.can import Database, Message, Signal
from cantools.database.conversion import BaseConversion
from cantools.database.errors import Error
from cantools.typechecking import Choices
from hypothesis import strategies as st

from typedcan.databases.database import Labels, Places, to_protocol
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.model import protocol as model

NO_FLAGS = FrameFlag(0)
_LABELS: Choices = OrderedDict({0: "no", 1: "yes"})
_FD_LENGTHS = [*range(9), 12, 16, 20, 24, 32, 48, 64]


@dataclass(frozen=True)
class Frame:
    """A frame as a test writes it."""

    frame_id: int
    data: bytes
    flags: FrameFlag = NO_FLAGS


def block_of(frames: Sequence[Frame], width: int | None = None) -> FrameBlock:
    """The frames as columns, a second apart."""
    longest = max((len(frame.data) for frame in frames), default=0)
    data = np.zeros((len(frames), width or (8 if longest <= 8 else 64)), np.uint8)
    for row, frame in enumerate(frames):
        data[row, : len(frame.data)] = list(frame.data)
    return FrameBlock(
        timestamp=np.arange(len(frames), dtype=np.float64),
        frame_id=np.array([frame.frame_id for frame in frames], np.uint32),
        flags=np.array([int(frame.flags) for frame in frames], np.uint8),
        channel=np.arange(len(frames), dtype=np.int16) % 3,
        length=np.array([len(frame.data) for frame in frames], np.uint8),
        data=data,
        channels=("can0", "can1", "can2"),
    )


def model_of(messages: Sequence[Message]) -> tuple[model.Message, ...]:
    """The messages as the decoder takes them."""
    nowhere = model.NOWHERE
    places = [Places(nowhere, [nowhere] * len(each.signals)) for each in messages]
    database = Database(list(messages), strict=False, sort_signals=None)
    return to_protocol(database, "test", places, Labels()).messages


def decoded_by_cantools(message: Message, data: bytes, *, scaling: bool) -> dict[str, Any] | None:
    """Values by signal, None where the frame is too short.

    Each signal is decoded in a message that has no other: cantools refuses whole messages where
    signals overlap, lie outside, or a multiplexer selects nothing. What it decodes whole is that.
    """
    if len(data) < message.length:
        return None
    alone = {
        name: pair for name in _alone(message) if (pair := _decoded_alone(message, name, data))
    }
    by_name = {signal.name: signal for signal in message.signals}

    def is_there(name: str) -> bool:
        above, ids = by_name[name].multiplexer_signal, by_name[name].multiplexer_ids
        if above is None:
            return name in alone
        return above in alone and alone[above][0] in (ids or ()) and is_there(above)

    values = {name: alone[name][scaling] for name in alone if is_there(name)}
    try:
        whole: Any = message.decode(data, decode_choices=False, scaling=scaling)
    except (DecodeError, ValueError):
        return values
    if not (scaling and _selects_by_scaled(message)):
        assert repr(dict(sorted(whole.items()))) == repr(dict(sorted(values.items())))
    return values


def _decoded_alone(message: Message, name: str, data: bytes) -> tuple[Any, Any] | None:
    reader = _alone(message)[name]
    try:
        raw: Any = reader.decode(data, decode_choices=False, scaling=False)
        scaled: Any = reader.decode(data, decode_choices=False)
    except (DecodeError, ValueError):
        return None
    return raw[name], scaled[name]


@cache
def _alone(message: Message) -> dict[str, Message]:
    """A message for each signal that has no other."""
    readers: dict[str, Message] = {}
    for signal in message.signals:
        own = copy(signal)
        own.is_multiplexer, own.multiplexer_ids, own.multiplexer_signal = False, None, None
        readers[own.name] = Message(1, "Alone", message.length, [own], strict=False)
    return readers


def _selects_by_scaled(message: Message) -> bool:
    """With scaling cantools compares selectors with physical values; a DBC means raw ones."""
    return any(
        each.is_multiplexer and (each.scale, each.offset) != (1, 0) for each in message.signals
    )


_integers = st.integers(-300, 300)
_floats = st.floats(-1e6, 1e6, allow_subnormal=False)
_numbers = st.one_of(
    st.sampled_from([1, -1, 0.1, 0.4, 0.001, -0.5, 2.0, 10, 1 << 40, 1e300]), _integers, _floats
)
_offsets = st.one_of(st.sampled_from([0, 0.0, -0.0, -40, 1000, 0.25, 1 << 60]), _integers, _floats)


@st.composite
def signals(draw: st.DrawFn, name: str, length: int) -> Signal:
    """A signal somewhere in a message of so many bytes; now and then it reaches beyond."""
    is_float = draw(st.integers(0, 5)) == 0
    if is_float:
        bits = draw(st.sampled_from([16, 32, 64]))
    else:
        bits = draw(st.one_of(st.integers(1, 16), st.integers(1, 64), st.integers(1, 8 * length)))
    choices = draw(st.sampled_from([None, None, _LABELS]))
    return Signal(
        name,
        start=draw(st.integers(0, 8 * length - 1)),
        length=bits,
        byte_order=draw(st.sampled_from(["little_endian", "big_endian"])),
        is_signed=draw(st.booleans()),
        conversion=BaseConversion.factory(
            scale=draw(st.one_of(st.just(1), _numbers).filter(bool)),
            offset=draw(st.one_of(st.just(0), _offsets)),
            choices=choices,
            is_float=is_float,
        ),
    )


@st.composite
def messages(draw: st.DrawFn, frame_id: int, *, is_extended: bool) -> Message:
    """A message with up to a dozen signals, most of them where they fit."""
    length = draw(st.sampled_from(_FD_LENGTHS[1:]))
    tidy = draw(st.integers(0, 9)) > 0
    kept: list[Signal] = []
    for number in range(draw(st.integers(0, 12))):
        signal = draw(signals(f"S{number}", length))
        selectors = [s for s in kept if s.length <= 20 and not s.is_float]
        nested = draw(st.booleans())
        if selectors and nested:
            parent = draw(st.sampled_from(selectors))
            ids = draw(st.lists(st.integers(0, min(7, (1 << parent.length) - 1)), min_size=1))
            parent.is_multiplexer = True
            signal.multiplexer_signal = parent.name
            signal.multiplexer_ids = ids
        if not tidy or _can_be_decoded([*kept, signal], length):
            kept.append(signal)
    name = f"M{frame_id:X}_{is_extended}"
    return Message(frame_id, name, length, kept, is_extended_frame=is_extended, strict=False)


def _can_be_decoded(chosen: list[Signal], length: int) -> bool:
    try:
        Message(1, "M", length, chosen, strict=True)
    except Error:
        return False
    return True


@st.composite
def databases(draw: st.DrawFn) -> list[Message]:
    """Messages of both kinds of identifier, the same number as both among them."""
    numbers = draw(st.lists(st.integers(0, 0x7FF), min_size=1, max_size=3, unique=True))
    kinds = st.sampled_from([(False,), (True,), (False, True)])
    return [
        draw(messages(number, is_extended=is_extended))
        for number in numbers
        for is_extended in draw(kinds)
    ]


def payload(source: Random, length: int) -> bytes:
    """Random bytes; often all the same, the smallest negative number, or small to select by."""
    same = [bytes(length), b"\xff" * length, (b"\x80" + bytes(length))[:length]]
    small = bytes(source.choices(range(8), k=length))
    return source.choice([*same, small, small, *(source.randbytes(length) for _ in range(5))])


def traffic(database: Sequence[Message], source: Random, count: int) -> list[Frame]:
    """Frames of the database's messages, short and long ones among them."""
    frames: list[Frame] = []
    for _ in range(count):
        message = source.choice(database)
        other = source.choice(_FD_LENGTHS)
        length = source.choice([message.length, message.length, message.length, other])
        flags = FrameFlag.EXTENDED if message.is_extended_frame else FrameFlag(0)
        frames.append(Frame(message.frame_id, payload(source, length), flags))
    return frames
