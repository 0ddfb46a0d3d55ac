"""What packs do that keep to a reading of the standard for a good reason, as alterations."""

from __future__ import annotations

from copy import copy
from functools import partial

import can
from rules.altered import Alteration, Frames, database, with_data

NUMBERS = {
    "B2V_Ucell": ("B2V_UC_CSCNo", "B2V_UC_FrameNo"),
    "B2V_Temp": ("B2V_T_CSCNo", "B2V_T_FrameNo"),
}
ANSWERS = {
    **dict.fromkeys(("B2V_BattInfo1", "B2V_BattInfo2"), 0.1),
    **dict.fromkeys((f"B2V_SysCode{number}" for number in range(1, 5)), 1.0),
}
"""Messages that answer requests, and the periods that A.1 prints for them."""


def _raw(name: str, frame: can.Message) -> dict[str, int]:
    message = database().get_message_by_name(name)
    values = message.decode(bytes(frame.data), decode_choices=False, scaling=False)
    assert isinstance(values, dict)
    return {signal: int(str(value)) for signal, value in values.items()}


def _is(name: str, frame: can.Message) -> bool:
    number: int = database().get_message_by_name(name).frame_id
    return number == frame.arbitration_id


def _every(name: str, frames: Frames) -> list[can.Message]:
    return [frame for frame in frames if _is(name, frame)]


def numbered_through(frames: Frames) -> Frames:
    """Frame numbers of cells and probes run on through the pack."""
    result = list(frames)
    for name, (group, number) in NUMBERS.items():
        message = database().get_message_by_name(name)
        raws = [_raw(name, frame) for frame in _every(name, frames)]
        keys = sorted({(raw[group], raw[number]) for raw in raws})
        for place, frame in enumerate(result):
            if _is(name, frame):
                raw = _raw(name, frame)
                raw[number] = keys.index((raw[group], raw[number])) + 1
                result[place] = with_data(frame, message.encode(raw, scaling=False, strict=False))
    return tuple(result)


def one_each_period(frames: Frames) -> Frames:
    """One frame of cells, and one of probes, each period: a cycle takes as many as there are."""
    result = [frame for frame in frames if not any(_is(name, frame) for name in NUMBERS)]
    for name, fields in NUMBERS.items():
        every = _every(name, frames)
        count = len({tuple(_raw(name, frame)[field] for field in fields) for frame in every})
        for burst in range(0, len(every), count):
            place = burst + burst // count % count
            other = copy(every[place if place < len(every) else place - count])
            other.timestamp = every[burst].timestamp
            result.append(other)
    return tuple(sorted(result, key=lambda frame: frame.timestamp))


def answers_always(frames: Frames) -> Frames:
    """Basic data and pack code come all the time at their periods."""
    result = [frame for frame in frames if not any(_is(name, frame) for name in ANSWERS)]
    end = frames[-1].timestamp
    for place, (name, period) in enumerate(ANSWERS.items()):
        first = _every(name, frames)[0]
        for number in range(int(end / period)):
            other = copy(first)
            other.timestamp = 0.004 + place * 0.001 + number * period
            result.append(other)
    return tuple(sorted(result, key=lambda frame: frame.timestamp))


def counts(name: str, byte: int, first: int, last: int) -> Alteration:
    """A counter in a byte of a message runs from first to last."""
    return partial(_counted, name, byte, first, last)


def _counted(name: str, byte: int, first: int, last: int, frames: Frames) -> Frames:
    result, value = [], last - 20
    for frame in frames:
        if _is(name, frame):
            data = bytearray(frame.data)
            data[byte] = value
            value = first if value == last else value + 1
            result.append(with_data(frame, bytes(data)))
        else:
            result.append(frame)
    return tuple(result)


def summed(frames: Frames) -> Frames:
    """The checksums of the pack code are sums."""
    names = [name for name in ANSWERS if "SysCode" in name]
    return tuple(
        with_data(frame, bytes([sum(frame.data[1:]) & 0xFF]) + bytes(frame.data[1:]))
        if any(_is(name, frame) for name in names)
        else frame
        for frame in frames
    )


def filled(name: str, byte: int, bits: int) -> Alteration:
    """Reserved bits of a message are 1."""

    def alter(frames: Frames) -> Frames:
        result = []
        for frame in frames:
            if _is(name, frame):
                data = bytearray(frame.data)
                data[byte] |= bits
                result.append(with_data(frame, bytes(data)))
            else:
                result.append(frame)
        return tuple(result)

    return alter
