"""Lines of one shape: the digits at the same columns, all other characters the same.

Such lines are read together, a column at a time. What their frames share (direction, channel,
flags, length) stands in characters that are the same, so that only one is read by itself.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.read.alike import lines_at
from typedcan.logs.read.digits import Words, decimal, flush_right, hex_number, seconds
from typedcan.logs.read.frame import LARGEST_ID, Frame
from typedcan.logs.read.payload import Payload

LONGEST_SHAPE = 504
"""Characters of a line that are compared at most; `lines.PADDING` must be more."""

_NUMBERS = ("whole", "fraction", "id", "number")


@dataclass(frozen=True, slots=True)
class Values:
    """What lines of a shape say; only the rows that are ``good`` have it.

    Parameters
    ----------
    timestamp
        As written: without the time at which the log began.
    frame_id
        The bare identifier.
    data
        Shape (n, 8) or (n, 64).
    good
        Which lines do have the shape.
    """

    timestamp: NDArray[np.float64]
    frame_id: NDArray[np.uint32]
    data: NDArray[np.uint8]
    good: NDArray[np.bool_]

    def begin_with(self, frame: Frame) -> bool:
        """Whether the first row is the frame that was read from the same line by itself."""
        return (
            bool(self.good[0])
            and float(self.timestamp[0]) == frame.timestamp
            and int(self.frame_id[0]) == frame.frame_id
            and self.data[0].tobytes().startswith(frame.data)
        )

    def kept(self) -> Self:
        """The good rows."""
        good = self.good
        return type(self)(self.timestamp[good], self.frame_id[good], self.data[good], good[good])


class Shape:
    """The shape of one line.

    Parameters
    ----------
    line
        The line, as matched by a format's pattern: its groups ``whole``, ``fraction`` (of the
        time; may be missing), ``id`` and ``data`` (may be empty) are digits; ``number`` is a
        number that nobody needs, ``skip`` what differs from line to line, and ``tail`` what nobody
        reads (any of them may be missing).
    payload
        How the payload is written.
    length
        Bytes of payload.
    time_unit
        What the time is divided by to make seconds.
    """

    def __init__(
        self, line: re.Match[bytes], payload: Payload, length: int, time_unit: int
    ) -> None:
        self._payload = payload
        self.length = length
        self._time_unit = time_unit
        self._fields = {name: line.span(name) for name in _NUMBERS if line.groupdict().get(name)}
        end = line.start("tail") if "tail" in line.re.groupindex else line.end()
        self._data = line.start("data")
        self._words = -(-end // 8)
        same = np.zeros(8 * self._words, np.uint8)
        same[:end] = 0xFF
        for first, last in self._fields.values():
            same[first:last] = 0
        for columns in payload.digits(self._data, length):
            same[columns] = 0
        if "skip" in line.re.groupindex:
            same[slice(*line.span("skip"))] = 0
        text = np.zeros(8 * self._words, np.uint8)
        text[:end] = np.frombuffer(line.string, np.uint8, end)
        self._same = same.view(np.uint64)[:, np.newaxis]
        self._text = text.view(np.uint64)[:, np.newaxis] & self._same

    def read(self, text: NDArray[np.uint8], starts: NDArray[np.int64]) -> Values:
        """The lines of a buffer that begin at ``starts``."""
        lanes: Words = np.ascontiguousarray(lines_at(text, starts, self._words).T)
        faults = np.bitwise_or.reduce((lanes & self._same) ^ self._text, axis=0)
        if "number" in self._fields:
            faults |= self._decimal(lanes, "number")[1]
        timestamp, wrong = self._time(lanes)
        faults |= wrong
        first, last = self._fields["id"]
        frame_id, wrong = hex_number(flush_right(lanes, first, last - first))
        faults |= wrong
        data, wrong = self._payload.read(lanes, self._data, self.length)
        faults |= wrong
        return Values(timestamp, frame_id, data, (faults == 0) & (frame_id <= LARGEST_ID))

    def _decimal(self, lanes: Words, name: str) -> tuple[Words, Words]:
        """A decimal number of up to ten digits."""
        first, last = self._fields[name]
        split = max(last - 8, first)
        value, faults = decimal(flush_right(lanes, split, last - split))
        if split > first:
            high, wrong = decimal(flush_right(lanes, first, split - first))
            value = value + high * np.uint64(10**8)
            faults = faults | wrong
        return value, faults

    def _time(self, lanes: Words) -> tuple[NDArray[np.float64], Words]:
        whole, faults = self._decimal(lanes, "whole")
        if "fraction" in self._fields:
            first, last = self._fields["fraction"]
            fraction, wrong = self._decimal(lanes, "fraction")
            time = seconds(whole, fraction, last - first)
            faults = faults | wrong
        else:
            time = whole.astype(np.float64)
        return (time if self._time_unit == 1 else time / self._time_unit), faults
