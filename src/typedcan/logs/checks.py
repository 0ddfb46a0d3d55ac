"""Length, checksum, alive counter and gaps, a block at a time, as the live runtime sees them."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from itertools import islice

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.checksums import (
    NONE,
    checksums_right,
    counter_places,
    raw_values,
)
from typedcan.logs.columns import Column, DecodedBlock, MessageColumns
from typedcan.logs.frames import FrameFlag
from typedcan.logs.protocol import Protocol
from typedcan.model.checksums.registry import Given
from typedcan.model.protection import Counter as AliveCounter
from typedcan.model.protocol import Message, Signal
from typedcan.model.seal import seals_of

PERIODS = 5
"""More than so many periods without a frame are a gap."""


_Stream = tuple[str, int | str | None, int]
"""A message on a channel, and its source address where it is found by its PGN."""


@dataclass(slots=True)
class Gaps:
    """The gaps of one message: how many, and the longest of them in seconds."""

    count: int = 0
    longest: float = 0.0

    def add(self, other: Gaps) -> None:
        """Add the gaps of another log."""
        self.count += other.count
        self.longest = max(self.longest, other.longest)


@dataclass(slots=True)
class Faults:
    """What was wrong with the frames of known messages, each by name of the message.

    Parameters
    ----------
    length
        Frames with fewer or more bytes than the message has.
    checksum
        Frames with a wrong checksum.
    counter
        Frames with a wrong alive counter, as `typedcan.wire.protect.ReceiveCounters` has it.
    format
        Frames of CAN FD where the message has classic CAN, or the other way round; their bits are
        those of the message.
    gaps
        Of messages that are sent periodically: more than `PERIODS` periods without a frame,
        between two frames or at the end of the log.
    """

    length: Counter[str] = field(default_factory=Counter[str])
    checksum: Counter[str] = field(default_factory=Counter[str])
    counter: Counter[str] = field(default_factory=Counter[str])
    format: Counter[str] = field(default_factory=Counter[str])
    gaps: dict[str, Gaps] = field(default_factory=dict[str, Gaps])

    def add(self, other: Faults) -> None:
        """Add the faults of another log."""
        self.length.update(other.length)
        self.checksum.update(other.checksum)
        self.counter.update(other.counter)
        self.format.update(other.format)
        for name, gaps in other.gaps.items():
            self.gaps.setdefault(name, Gaps()).add(gaps)


@dataclass(frozen=True, slots=True)
class _Counting:
    """The alive counter of a message: where it is and how it runs."""

    signal: Signal
    runs: AliveCounter
    reserved: tuple[int, ...]


class Checks:
    """Checks the decoded frames of one log, block after block.

    Frames with a wrong length or checksum are taken out, since the live runtime refuses them too.
    Counters and gaps are followed for each channel on its own, and for each source address of
    messages that are found by their PGN.

    Parameters
    ----------
    protocol
        The messages.
    keep_faulty
        Count wrong lengths and checksums, but leave the frames in. Their counters are passed over
        all the same.
    algorithms
        What computes checksums that are not known here, as `typedcan.wire.codec.Codec` has it.

    Raises
    ------
    AlgorithmError
        No message has an algorithm of a name that is given, or what is given is none.
    """

    def __init__(
        self, protocol: Protocol, *, keep_faulty: bool = False, algorithms: Given = NONE
    ) -> None:
        self.faults = Faults()
        self._checked = protocol.checked
        self._algorithms = algorithms
        self._sealed = seals_of(protocol.checked.values(), algorithms).keys()
        self._periods = {
            name: period
            for name, period in protocol.periods.items()
            if name not in protocol.conditional
        }
        self._formats_known = protocol.formats_known
        self._keep_faulty = keep_faulty
        self._counting = _counters(protocol)
        self._last_counter: dict[_Stream, int | None] = {}
        self._last_time: dict[_Stream, float] = {}
        self._end = -np.inf

    def take(self, decoded: DecodedBlock) -> DecodedBlock:
        """Check a block; what comes back is without the frames that are refused."""
        messages: dict[str, MessageColumns] = {}
        counts = decoded.counts
        self.faults.length.update(counts.too_short)
        blocks = (columns.block for columns in decoded.messages.values())
        any_fd = any((block.flags & FrameFlag.FD).any() for block in islice(blocks, 1))
        for name, columns in decoded.messages.items():
            kept = sound = columns
            message = self._checked[name]
            good = self._good(message, columns)
            if good is not None:
                sound = rows_where(columns, good)
                kept = columns if self._keep_faulty else sound
                counts.decoded[name] += len(kept) - len(columns)
            if len(sound):
                if self._formats_known and (any_fd or message.is_fd):
                    self._formats(message, sound)
                self._follow(name, sound)
            if len(kept):
                messages[name] = kept
            else:
                del counts.decoded[name]
        return DecodedBlock(messages, counts)

    def finish(self) -> Faults:
        """What was found, with the gaps at the end of the log."""
        for (name, *_), last in self._last_time.items():
            self._gaps(name, np.array([last, self._end]))
        self._last_time = {}
        return self.faults

    def _good(self, message: Message, columns: MessageColumns) -> NDArray[np.bool_] | None:
        """The frames that are not refused; None: all."""
        lengths = columns.block.length[columns.rows]
        good = lengths == message.length
        if message.frame_length != message.length:  # of a CAN FD frame that is filled up
            good |= lengths == message.frame_length
        wrong = len(good) - int(np.count_nonzero(good))
        if wrong:
            self.faults.length[message.name] += wrong
        if message.name in self._sealed:
            payload = columns.block.data[columns.rows]
            right = checksums_right(message, payload, self._algorithms)
            wrong = int(np.count_nonzero(good & ~right))
            if wrong:
                self.faults.checksum[message.name] += wrong
            good &= right
        return None if good.all() else good

    def _formats(self, message: Message, columns: MessageColumns) -> None:
        """Count the frames that have another format than their message."""
        of_fd = int(np.count_nonzero(columns.block.flags[columns.rows] & FrameFlag.FD))
        if wrong := len(columns) - of_fd if message.is_fd else of_fd:
            self.faults.format[message.name] += wrong

    def _follow(self, name: str, columns: MessageColumns) -> None:
        """Counter and gaps of one message, by channel and, of one found by PGN, by sender."""
        times = columns.timestamp
        stream: NDArray[np.int16] | NDArray[np.int32] = columns.channel
        if columns.by_pgn:  # numbers of 16 bits are sorted much faster
            stream = stream.astype(np.int32) + (columns.addresses[0].astype(np.int32) << 16)
        counting, period = self._counting.get(name), self._periods.get(name)
        self._end = max(self._end, float(times.max()))
        if counting is None and period is None:
            return
        for number in np.unique(stream).tolist():
            own = slice(None) if (stream == number).all() else np.flatnonzero(stream == number)
            key = name, columns.block.channels[number & 0xFFFF], number >> 16
            if counting is not None:
                values = raw_values(counting.signal, columns.block.data[columns.rows[own]])
                self._counter(key, counting, values)
            if period is not None:
                last = self._last_time.get(key, float(times[own][0]))
                self._gaps(name, np.append(np.float64(last), times[own]))
                self._last_time[key] = float(times[own][-1])

    def _counter(self, key: _Stream, counting: _Counting, values: NDArray[np.uint64]) -> None:
        numbers = counter_places(counting.runs, values)
        sound = (numbers >= 0) & ~np.isin(values, counting.reserved)
        last = self._last_counter.get(key)
        before = np.append(
            np.int64(-1 if last is None else last), np.where(sound, numbers, -1)[:-1]
        )
        follows = (before < 0) | (numbers == (before + 1) % counting.runs.modulus)
        wrong = int(np.count_nonzero(~(sound & follows)))
        if wrong:
            self.faults.counter[key[0]] += wrong
        self._last_counter[key] = int(numbers[-1]) if sound[-1] else None

    def _gaps(self, name: str, times: NDArray[np.float64]) -> None:
        steps = np.diff(times)
        long = steps[steps > PERIODS * self._periods[name]]
        if len(long):
            self.faults.gaps.setdefault(name, Gaps()).add(Gaps(len(long), float(long.max())))


def rows_where(columns: MessageColumns, kept: NDArray[np.bool_]) -> MessageColumns:
    """The frames of a message that are kept."""
    return MessageColumns(
        columns.name,
        columns.frame_id,
        columns.is_extended,
        columns.block,
        columns.rows[kept],
        {name: taken(column, kept) for name, column in columns.columns.items()},
        columns.by_pgn,
    )


def taken(column: Column, rows: NDArray[np.bool_] | NDArray[np.int64]) -> Column:
    """Some rows of a column, copied."""
    return Column(
        column.signal,
        column.values[rows],
        None if column.valid is None else column.valid[rows],
        None if column.state is None else column.state[rows],
    )


def _counters(protocol: Protocol) -> dict[str, _Counting]:
    """By message, the alive counters that can be followed."""
    counters: dict[str, _Counting] = {}
    for message in protocol.messages:
        counter = protocol.checked[message.name].counter
        if counter:
            signal = message.signal(counter.signal)
            reserved = tuple(protocol.reserved.get((message.name, counter.signal), ()))
            counters[message.name] = _Counting(signal, counter, reserved)
    return counters
