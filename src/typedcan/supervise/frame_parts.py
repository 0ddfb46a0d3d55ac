"""The frames of a message that takes several: told apart by group and frame number."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from typedcan.model.transfer import Counted
from typedcan.supervise.bit_places import ByteOrder
from typedcan.supervise.events import SignalChanged, SignalKind
from typedcan.supervise.periods import Periods
from typedcan.supervise.signal_watch import Signals, Watch, WatchedField
from typedcan.supervise.snapshot import SignalSnapshot
from typedcan.wire.link import Received
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer

MOST_PARTS = 1024
"""How many different frames of one message are kept apart; a pack needs some 100."""

SET_CLOCK = 1.0
"""Seconds by which a time of timestamps may be longer than the same time of the clock.

Timestamps are times of day on most interfaces; a longer one is a time of day that was set.
"""


def frames_of(protocol: Protocol, message: type[Message]) -> Transfer | None:
    """The transfer for which a message takes several frames, if it does."""
    for transfer in protocol.transfers:
        if transfer.frame_number and transfer.frame_number.message is message:
            return transfer
    return None


def time_between(stamp: float, last_stamp: float, elapsed: float) -> float:
    """Seconds between two frames: of their timestamps, or of the clock where those are no use.

    Timestamps that stand still, go back or were not there before are of no use.
    """
    measured = stamp - last_stamp
    return measured if 0.0 < measured < elapsed + SET_CLOCK else elapsed


class _Part:
    """When a frame of one number came last, and what its signals said."""

    __slots__ = ("last", "signals", "stamp")

    def __init__(self, last: float, stamp: float, signals: Signals) -> None:
        self.last = last
        self.stamp = stamp
        self.signals = signals


class Parts:
    """The different frames of one message.

    Parameters
    ----------
    transfer
        Which fields number the frames and which hold the parts of the value.
    numbering
        Which bits of the payload number the frames.
    order
        The order of bytes in which the payload is one number.
    fields
        The watched fields of the message.
    periods
        What takes the times between frames of the same number.
    onsets
        Where to count how often something began to be wrong.
    """

    def __init__(
        self,
        transfer: Transfer,
        numbering: int,
        order: ByteOrder,
        fields: Mapping[str, WatchedField],
        periods: Periods,
        onsets: dict[SignalKind, int],
    ) -> None:
        numbered = [ref.field for ref in (transfer.group, transfer.frame_number) if ref]
        self._group = numbered[0] if transfer.group else None
        self._number = numbered[-1]
        self._items = [ref.field for ref in transfer.items]
        facts = transfer.parts.transfer
        is_counted = facts.count and not facts.group and facts.counted is Counted.ITEMS
        self._count = facts.count if is_counted else None
        self._first = facts.first_number
        self._fields = fields
        self._numbering = numbering
        self._order: ByteOrder = order
        self._watch = self._watch_of(len(self._items))
        self._periods = periods
        self._onsets = onsets
        self._parts: dict[int, _Part] = {}  # by the bits that number them

    def take(
        self, received: Received[Message], now: float, stamp: float
    ) -> list[SignalChanged] | None:
        """Measure a frame; what changed in its signals.

        Raises `LookupError` where the frame cannot be told apart from others.
        """
        bits = int.from_bytes(received.data, self._order) & self._numbering
        part = self._parts.get(bits)
        if part is None:
            part = self._parts[bits] = self._new(received.message, now, stamp)
        else:
            self._periods.add(time_between(stamp, part.stamp, now - part.last))
            part.last = now
            part.stamp = stamp
        return part.signals.take(received, now)

    def snapshot(self, message: type[Message]) -> Iterator[SignalSnapshot]:
        """The signals that say something is wrong now."""
        for part in self._parts.values():
            yield from part.signals.snapshot(message)

    def _new(self, message: Message, now: float, stamp: float) -> _Part:
        number = getattr(message, self._number)
        key = (getattr(message, self._group), number) if self._group else (number,)
        if len(self._parts) == MOST_PARTS or not all(isinstance(number, int) for number in key):
            raise LookupError(key)
        used = len(self._items)
        if self._count is not None:
            used = min(used, max(0, self._count - used * (key[-1] - self._first)))
        watch = self._watch if used == len(self._items) else self._watch_of(used)
        return _Part(now, stamp, Signals(watch, self._onsets, key))

    def _watch_of(self, used: int) -> Watch:
        """The watched among the items; bytes behind the last item mean nothing."""
        fields = (self._fields[name] for name in self._items[:used] if name in self._fields)
        return Watch(fields, self._order)
