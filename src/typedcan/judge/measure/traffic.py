"""How many frames of each message come, and how many the standard asks for."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.decoded import DecodedChunk
from typedcan.judge.measure.presence import periods_of
from typedcan.judge.measure.steps import key_of, keyed
from typedcan.judge.series import Series
from typedcan.model.frame_time import Bits
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer

Channel = int | str | None


class _Totals(NamedTuple):
    """How many groups a pack has, and how many items in all."""

    groups: int
    items: int


class Traffic:
    """Counts the frames of one log."""

    def __init__(self, protocol: Protocol) -> None:
        self.frames: Counter[type[Message]] = Counter()
        self.channels: dict[type[Message], Channel] = {}
        self._messages = protocol.messages
        self._buses = protocol.model.buses
        self._periods = periods_of(protocol)
        self._keyed = keyed(protocol)
        self._transfers = {
            transfer.messages[0]: transfer
            for transfer in protocol.transfers
            if transfer.messages[0] in self._keyed
        }
        self._keys = {message: np.zeros(1 << 16, np.bool_) for message in self._keyed}
        self._totals: dict[type[Message], _Totals] = {}

    def feed(self, chunk: DecodedChunk) -> None:
        """Count the next frames."""
        for message in self._messages:
            series = chunk.frames(message)
            if not series.fresh:
                continue
            self.frames[message] += series.fresh
            if message not in self.channels:
                place = chunk.block.channel[series.order[-1] - chunk.first_order]
                self.channels[message] = chunk.block.channels[place]
            if message in self._keyed:
                self._keys[message][key_of(series, self._keyed[message])] = True
        for message, transfer in self._transfers.items():
            self._tell(message, transfer, chunk)

    def always(self, channel: Channel) -> list[type[Message]]:
        """The messages seen on a channel that the standard has sent always."""
        return [message for message in self._periods if self.channels.get(message, ...) == channel]

    def bit_rate(self, channel: Channel) -> int:
        """Bit/s of the bus that a channel is: the first that has all nodes heard there, or 0."""
        heard = {message.SENDER for message, each in self.channels.items() if each == channel}
        fitting = [bus.bit_rate for bus in self._buses if heard <= set(bus.nodes)]
        every = fitting or [bus.bit_rate for bus in self._buses]
        return every[0] if every else 0

    def per_cycle(self, message: type[Message]) -> int:
        """How many frames of a message make one cycle.

        Where the pack told its numbers, its items are split evenly over its groups; if it sends
        more, as it must with another split, those that it sends, but no more than any split needs.
        Where it did not, as many as came with different numbers.
        """
        if message not in self._keyed:
            return 1
        seen = int(np.count_nonzero(self._keys[message]))
        totals = self._totals.get(message)
        if totals is None:
            return seen
        size = len(self._transfers[message].items)
        each, more = divmod(totals.items, totals.groups)
        even = more * -(-(each + 1) // size) + (totals.groups - more) * -(-each // size)
        most = (totals.items + (size - 1) * totals.groups) // size
        return max(even, min(seen, most))

    def rate(self, message: type[Message]) -> float:
        """Frames per second that the standard asks for of a message that is sent always."""
        return self.per_cycle(message) / self._periods[message]

    def _tell(self, message: type[Message], transfer: Transfer, chunk: DecodedChunk) -> None:
        """Note the last totals that are none of the codes for having none."""
        groups, items = transfer.groups_field, transfer.count_field
        if groups is None or items is None:
            return
        series = chunk.sound(groups.message)
        if series.fresh:
            known = np.flatnonzero(_positive(series, groups.field) & _positive(series, items.field))
            if len(known):
                row = known[-1]
                self._totals[message] = _Totals(
                    int(series.raw(groups.field)[row]), int(series.raw(items.field)[row])
                )


def bits_of(message: type[Message]) -> Bits:
    """The bits of one frame of a message."""
    return Bits.of(message.LENGTH, extended=message.EXTENDED)


def _positive(series: Series, field: str) -> NDArray[np.bool_]:
    """Where there is a value above 0."""
    return series.value(field) > 0
