"""The columns of all messages of a database beside cantools, value by value."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from cantools.database.can import Message as CantoolsMessage

from typedcan.dynamic import typed_protocol
from typedcan.logs.columns import Column, MessageColumns
from typedcan.logs.decode import Decoder
from typedcan.logs.frames import FrameBlock, FrameFlag
from typedcan.logs.plan import Mode
from typedcan.logs.protocol import Protocol as Messages
from typedcan.logs.protocol import read
from typedcan.model import protocol as model
from typedcan.model.protocol import FD_LENGTHS
from typedcan.payloads import payloads
from typedcan.trial import Oracle, Values

ByIdentifier = Mapping[tuple[bool, int], CantoolsMessage]


def column_faults(protocol: model.Protocol, theirs: ByIdentifier) -> tuple[int, list[str]]:
    """How many values are as cantools has them, and what is wrong, a line for each message."""
    messages = read(protocol, "corpus")
    frames = [*_frames(protocol, messages)]
    block = _block([(kind, data) for kind, data in frames])
    decoders = {mode: Decoder(messages.messages, mode=mode) for mode in (Mode.RAW, Mode.PHYSICAL)}
    decoded = {mode: decoder.decode(block).messages for mode, decoder in decoders.items()}
    compared, faults = 0, []
    for message in messages.messages:
        if message.name in messages.hidden or message.length > FD_LENGTHS[-1]:
            continue
        oracle = Oracle(message.signals, theirs[message.extended, message.frame_id])
        names = [signal.name for signal in message.signals]
        own = [data for each, data in frames if each is message]
        for place, data in enumerate(own):
            values = oracle.values(data, names)
            for which, mode in enumerate(decoded):
                fault = _fault(decoded[mode][message.name], place, names, values, which)
                if fault:
                    faults.append(f"{message.name}: {fault} in {data.hex()} ({mode.value})")
                    break
                compared += len(values)
    return compared, faults


def _frames(protocol: model.Protocol, messages: Messages) -> Iterator[tuple[model.Message, bytes]]:
    kinds = {kind.NAME: kind for kind in typed_protocol(protocol).messages}
    for message in messages.messages:
        if message.name not in messages.hidden and message.length <= FD_LENGTHS[-1]:
            for data in payloads(kinds[message.name]):
                yield message, data


def _block(frames: Sequence[tuple[model.Message, bytes]]) -> FrameBlock:
    data = np.zeros((len(frames), FD_LENGTHS[-1]), np.uint8)
    for row, (_, payload) in enumerate(frames):
        data[row, : len(payload)] = list(payload)
    extended = [FrameFlag.EXTENDED if message.extended else 0 for message, _ in frames]
    return FrameBlock(
        timestamp=np.arange(len(frames), dtype=np.float64),
        frame_id=np.array([message.frame_id for message, _ in frames], np.uint32),
        flags=np.array(extended, np.uint8),
        channel=np.zeros(len(frames), np.int16),
        length=np.array([len(payload) for _, payload in frames], np.uint8),
        data=data,
        channels=(None,),
    )


def _fault(
    columns: MessageColumns, place: int, names: Sequence[str], values: Values, which: int
) -> str:
    for name in names:
        value = _value(columns.columns[name], place)
        expected = values[name][which] if name in values else None
        if not _same(value, expected):
            return f"{name} is {value!r}, cantools has {expected!r}"
    return ""


def _value(column: Column, place: int) -> Any:
    if column.valid is not None and not column.valid[place]:
        return None
    value = column.values[place]
    return value.item() if isinstance(value, np.generic) else value


def _same(value: Any, expected: Any) -> bool:
    if isinstance(expected, float) and math.isnan(expected):
        return isinstance(value, float) and math.isnan(value)
    return (value is None) == (expected is None) and bool(value == expected)
