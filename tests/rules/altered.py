"""Recorded frames altered in one place, by means of cantools: the rest stays bit for bit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from copy import copy
from functools import cache, reduce
from operator import xor

import can
import cantools
from cantools.database.can import Database, Message

from swapcan.wire import dbc_text

Frames = tuple[can.Message, ...]
Alteration = Callable[[Frames], Frames]

_WITH_XOR = ("B2V_ST1", "V2B_CMD", "V2B_RQData", *(f"B2V_SysCode{n}" for n in range(1, 5)))
"""Messages whose first byte is the XOR of the others: tables 1, 8, 14 and 16."""


@cache
def database() -> Database:
    """The packaged DBC, as cantools reads it."""
    loaded = cantools.database.load_string(dbc_text(), "dbc")
    assert isinstance(loaded, Database)
    return loaded


def _message(name: str) -> Message:
    return database().get_message_by_name(name)


def sealed(name: str, data: bytes) -> bytes:
    """The payload of a message with its checksum, where it has one that the standard states."""
    return bytes([reduce(xor, data[1:])]) + data[1:] if name in _WITH_XOR else data


def with_data(frame: can.Message, data: bytes) -> can.Message:
    """The same frame with another payload."""
    other = copy(frame)
    other.data = bytearray(data)
    other.dlc = len(data)
    return other


def signals(name: str, begin: float, end: float | None = None, **raw: int) -> Alteration:
    """Raw values of signals, in all frames of a message from begin to end or in the first only.

    The checksum is made right.
    """
    return signals_where({}, name, begin, end, **raw)


def signals_where(
    only: Mapping[str, int], name: str, begin: float, end: float | None = None, **raw: int
) -> Alteration:
    """The same in those frames only that have some raw values already."""
    message = _message(name)

    def alter(frames: Frames) -> Frames:
        result, done = [], False
        for frame in frames:
            mine = frame.arbitration_id == message.frame_id and frame.timestamp >= begin
            if mine and (frame.timestamp <= end if end is not None else not done):
                values = message.decode(bytes(frame.data), decode_choices=False, scaling=False)
                assert isinstance(values, dict)
                assert raw.keys() <= values.keys()
                if only.items() <= values.items():
                    data = message.encode(values | raw, scaling=False, strict=False)
                    result.append(with_data(frame, sealed(name, data)))
                    done = True
                    continue
            result.append(frame)
        assert done
        return tuple(result)

    return alter


def changed(
    name: str, at: float, change: Callable[[can.Message], Iterable[can.Message]]
) -> Alteration:
    """What the first frame of a message from a time on becomes: nothing, another one, several."""
    number = _message(name).frame_id

    def alter(frames: Frames) -> Frames:
        place = next(
            place
            for place, frame in enumerate(frames)
            if frame.arbitration_id == number and frame.timestamp >= at
        )
        every = [*frames[:place], *change(frames[place]), *frames[place + 1 :]]
        return tuple(sorted(every, key=lambda frame: frame.timestamp))

    return alter


def lost(name: str, at: float) -> Alteration:
    """Without one frame."""
    return changed(name, at, lambda _: ())


def lost_between(names: Iterable[str], begin: float, end: float) -> Alteration:
    """Without all frames of some messages from begin to end."""
    numbers = {_message(name).frame_id for name in names}

    def alter(frames: Frames) -> Frames:
        kept = [
            frame
            for frame in frames
            if frame.arbitration_id not in numbers or not begin <= frame.timestamp <= end
        ]
        assert len(kept) < len(frames)
        return tuple(kept)

    return alter


def moved(name: str, at: float, by: float) -> Alteration:
    """One frame with another time stamp."""

    def move(frame: can.Message) -> list[can.Message]:
        other = copy(frame)
        other.timestamp += by
        return [other]

    return changed(name, at, move)


def byte(name: str, at: float, place: int, flip: int) -> Alteration:
    """One byte with some bits turned over, and nothing else made right."""

    def turn(frame: can.Message) -> list[can.Message]:
        data = bytearray(frame.data)
        data[place] ^= flip
        return [with_data(frame, bytes(data))]

    return changed(name, at, turn)


def added(name: str, at: float, *, later: float = 0.0, **attributes: object) -> Alteration:
    """A copy of one frame beside it or later, with other attributes of `can.Message`."""

    def double(frame: can.Message) -> list[can.Message]:
        other = copy(frame)
        other.timestamp += later
        for attribute, value in attributes.items():
            setattr(other, attribute, value)
        return [frame, other]

    return changed(name, at, double)


def again(name: str, at: float, *, times: int, every: float) -> Alteration:
    """One frame so many times more, so many seconds from one to the next."""

    def repeat(frame: can.Message) -> list[can.Message]:
        copies = [copy(frame) for _ in range(times + 1)]
        for number, other in enumerate(copies):
            other.timestamp += number * every
        return copies

    return changed(name, at, repeat)


def paced(name: str, factor: float, *, uneven: float = 0.0) -> Alteration:
    """A message slower by a factor, and every other frame so many seconds later."""
    number = _message(name).frame_id

    def alter(frames: Frames) -> Frames:
        end = frames[-1].timestamp
        result, count, first = [], 0, 0.0
        for frame in frames:
            if frame.arbitration_id != number:
                result.append(frame)
                continue
            first = first if count else frame.timestamp
            other = copy(frame)
            other.timestamp = first + (frame.timestamp - first) * factor + uneven * (count % 2)
            count += 1
            if other.timestamp <= end:
                result.append(other)
        return tuple(sorted(result, key=lambda frame: frame.timestamp))

    return alter


def on_channel(name: str, channel: str) -> Alteration:
    """All frames of a message on another channel."""
    number = _message(name).frame_id

    def alter(frames: Frames) -> Frames:
        moved = []
        for frame in frames:
            other = copy(frame)
            if frame.arbitration_id == number:
                other.channel = channel
            moved.append(other)
        return tuple(moved)

    return alter


def doubled(name: str, later: float) -> Alteration:
    """A copy of each frame of a message, so many seconds after it."""
    number = _message(name).frame_id

    def alter(frames: Frames) -> Frames:
        copies = [copy(frame) for frame in frames if frame.arbitration_id == number]
        for other in copies:
            other.timestamp += later
        return tuple(sorted([*frames, *copies], key=lambda frame: frame.timestamp))

    return alter


def swapped(name: str, at: float) -> Alteration:
    """The payloads of two successive frames of a message exchanged."""
    number = _message(name).frame_id

    def alter(frames: Frames) -> Frames:
        one, two, *_ = (
            place
            for place, frame in enumerate(frames)
            if frame.arbitration_id == number and frame.timestamp >= at
        )
        result = list(frames)
        result[one] = with_data(frames[one], bytes(frames[two].data))
        result[two] = with_data(frames[two], bytes(frames[one].data))
        return tuple(result)

    return alter


def both(*alterations: Alteration) -> Alteration:
    """One after the other."""
    return lambda frames: reduce(lambda so_far, alter: alter(so_far), alterations, frames)
