"""What all reactions share: some signals of a short record, kept to be judged in the end."""

from __future__ import annotations

from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings
from typedcan.judge.rule import Watcher
from typedcan.wire.protocol import FieldRef

PACK = "BMU"
"""The node whose reactions these are."""


class Track(NamedTuple):
    """A signal over a record, one row per frame in their order.

    ``time`` is in seconds since the record's begin, ``order`` the frame's number, ``value`` raw,
    ``sound`` whether the frame's checksum is right.
    """

    time: NDArray[np.float64]
    order: NDArray[np.int64]
    value: NDArray[np.int64]
    sound: NDArray[np.bool_]

    def where(self, rows: NDArray[np.bool_]) -> Self:
        """Some of the rows."""
        return self._replace(
            time=self.time[rows],
            order=self.order[rows],
            value=self.value[rows],
            sound=self.sound[rows],
        )

    def of(self, *values: int) -> Self:
        """The rows with one of some values."""
        return self.where(np.isin(self.value, values))

    def after(self, order: int) -> Self:
        """The rows behind a frame."""
        return self.where(self.order > order)

    def between(self, start: float, end: float) -> Self:
        """The rows from one second to another, both included."""
        return self.where((self.time >= start) & (self.time <= end))

    def at(self, order: int) -> int | None:
        """The value that was the last before a frame, None where there is none."""
        row = int(np.searchsorted(self.order, order)) - 1
        return int(self.value[row]) if row >= 0 else None

    @property
    def empty(self) -> bool:
        """Whether there is no row."""
        return not len(self.time)


class Reaction(Watcher):
    """Keeps the signals that it ``wants``; `finish` is to judge them."""

    wants: ClassVar[tuple[FieldRef, ...]] = ()

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._parts: dict[FieldRef, list[Track]] = {ref: [] for ref in self.wants}

    def feed(self, chunk: Chunk) -> None:
        """Keep what is wanted."""
        for ref, parts in self._parts.items():
            series = chunk.frames(ref.message)
            new = slice(series.first, None)
            order = series.order[new].copy()
            value = series.raw(ref.field)[new].copy()
            sound = np.isin(order, chunk.sound(ref.message).order)
            parts.append(Track(series.time[new].copy(), order, value, sound))

    def every(self, ref: FieldRef) -> Track:
        """A signal in all frames, whatever their checksum."""
        parts = self._parts[ref]
        if not parts:
            none = np.empty(0, np.int64)
            return Track(np.empty(0), none, none, np.empty(0, np.bool_))
        return Track(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))

    def track(self, ref: FieldRef) -> Track:
        """A signal in the frames that can be believed."""
        every = self.every(ref)
        return every.where(every.sound)


def first(track: Track) -> tuple[float, int] | None:
    """Time and number of the first frame, None where there is none."""
    return None if track.empty else (float(track.time[0]), int(track.order[0]))
