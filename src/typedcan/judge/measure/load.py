"""How busy each bus was, beside what the standard asks for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from typedcan.judge.decoded import DecodedChunk
from typedcan.judge.measure.traffic import Channel, Traffic, bits_of
from typedcan.logs.frames import FrameFlag
from typedcan.model.frame_time import Bits

_LENGTHS = 256
"""More than any number of bytes that a block can hold."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """The load of one bus, as shares of its bit rate.

    Parameters
    ----------
    channel
        As python-can gives it; empty where the log has no channels.
    measured, measured_stuffed
        By all frames on it, without stuff bits and with the most there can be. Error frames are
        not counted, CAN FD frames as classical ones of their length.
    own, own_stuffed
        The part of it that messages of the protocol have.
    expected, expected_stuffed
        What the messages seen on it make at their printed periods, for the pack's numbers;
        without those that are sent on events or on request.
    bit_rate
        Bit/s, as the protocol states it for the bus.
    """

    channel: str
    measured: float
    measured_stuffed: float
    own: float
    own_stuffed: float
    expected: float
    expected_stuffed: float
    bit_rate: int


class LoadMeter:
    """Counts the bits of one log."""

    def __init__(self) -> None:
        self._bits: dict[Channel, Bits] = {}

    def feed(self, chunk: DecodedChunk) -> None:
        """Count the next frames."""
        block = chunk.block
        # One number per kind of frame, so that a single count tells all of them apart.
        kinds = block.channel.astype(np.intp)
        kinds *= 4 * _LENGTHS
        kinds += (block.flags & np.uint8(FrameFlag.EXTENDED | FrameFlag.REMOTE)) * np.intp(_LENGTHS)
        kinds += block.length
        counts = np.bincount(kinds[(block.flags & np.uint8(FrameFlag.ERROR)) == 0])
        for kind in np.flatnonzero(counts).tolist():
            place, rest = divmod(kind, 4 * _LENGTHS)
            flags, length = divmod(rest, _LENGTHS)
            bits = Bits.of(
                0 if flags & FrameFlag.REMOTE else length, extended=bool(flags & FrameFlag.EXTENDED)
            )
            channel = block.channels[place]
            self._bits[channel] = self._bits.get(channel, Bits()).plus(bits, int(counts[kind]))

    def finish(self, end: float, traffic: Traffic) -> tuple[Load, ...]:
        """The load of each channel, in the order in which they came.

        None of a log of no length, nor of a bus whose bit rate the protocol does not state.
        """
        if end <= 0:
            return ()
        rates = {channel: traffic.bit_rate(channel) for channel in self._bits}
        return tuple(self._load(each, end, rate, traffic) for each, rate in rates.items() if rate)

    def _load(self, channel: Channel, seconds: float, rate: int, traffic: Traffic) -> Load:
        own = expected = Bits()
        for message, home in traffic.channels.items():
            if home == channel:
                own = own.plus(bits_of(message), traffic.frames[message])
        for message in traffic.always(channel):
            expected = expected.plus(bits_of(message), traffic.rate(message))
        measured = self._bits[channel]
        return Load(
            channel="" if channel is None else str(channel),
            measured=measured.bare / seconds / rate,
            measured_stuffed=measured.stuffed / seconds / rate,
            own=own.bare / seconds / rate,
            own_stuffed=own.stuffed / seconds / rate,
            expected=expected.bare / rate,
            expected_stuffed=expected.stuffed / rate,
            bit_rate=rate,
        )
