"""How many frames of each message come, and how many the standard asks for."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.measure.presence import PERIODS
from swapcan.conform.measure.steps import KEYED, key_of
from swapcan.conform.series import Series
from typedcan.wire.message import Message
from typedcan.wire.protocol import Transfer

Channel = int | str | None

_CYCLES = {
    transfer.messages[0]: transfer
    for transfer in PROTOCOL.transfers
    if transfer.messages[0] in KEYED
}


class _Totals(NamedTuple):
    """How many groups a pack has, and how many items in all."""

    groups: int
    items: int


class Traffic:
    """Counts the frames of one log."""

    def __init__(self) -> None:
        self.frames: Counter[type[Message]] = Counter()
        self.channels: dict[type[Message], Channel] = {}
        self._keys = {message: np.zeros(1 << 16, np.bool_) for message in KEYED}
        self._totals: dict[type[Message], _Totals] = {}

    def take(self, chunk: Chunk) -> None:
        """Count the next frames."""
        for message in PROTOCOL.messages:
            series = chunk.frames(message)
            if not series.fresh:
                continue
            self.frames[message] += series.fresh
            if message not in self.channels:
                place = chunk.block.channel[series.order[-1] - chunk.first_order]
                self.channels[message] = chunk.block.channels[place]
            if message in KEYED:
                self._keys[message][key_of(series)] = True
        for message, transfer in _CYCLES.items():
            self._tell(message, transfer, chunk)

    def always(self, channel: Channel) -> list[type[Message]]:
        """The messages seen on a channel that the standard has sent always."""
        return [message for message in PERIODS if self.channels.get(message, ...) == channel]

    def per_cycle(self, message: type[Message]) -> int:
        """How many frames of a message make one cycle.

        Where the pack told its numbers, its items are split evenly over its groups; if it sends
        more, as it must with another split, those that it sends, but no more than any split needs.
        Where it did not, as many as came with different numbers.
        """
        if message not in KEYED:
            return 1
        seen = int(np.count_nonzero(self._keys[message]))
        totals = self._totals.get(message)
        if totals is None:
            return seen
        size = len(_CYCLES[message].items)
        each, more = divmod(totals.items, totals.groups)
        even = more * -(-(each + 1) // size) + (totals.groups - more) * -(-each // size)
        most = (totals.items + (size - 1) * totals.groups) // size
        return max(even, min(seen, most))

    def rate(self, message: type[Message]) -> float:
        """Frames per second that the standard asks for of a message that is sent always."""
        return self.per_cycle(message) / PERIODS[message]

    def _tell(self, message: type[Message], transfer: Transfer, chunk: Chunk) -> None:
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


def _positive(series: Series, field: str) -> NDArray[np.bool_]:
    """Where there is a value above 0."""
    return series.value(field) > 0
