"""One signal on one channel, block after block: its points or states, and where it has none."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from typedcan.logs.columns import Column, SignalInfo, State
from typedcan.logs.plot.model import GAP_PERIODS, Band, Curve, Mark
from typedcan.logs.plot.thin import Points, SpanList, begins_anew

_MARKS = {State.INVALID: Mark.INVALID, State.ABNORMAL: Mark.ABNORMAL}


class Track:
    """Takes the values of a signal.

    Parameters
    ----------
    info
        The signal.
    reserved
        Raw codes that are no value.
    period
        Seconds between frames, None where there is no period.
    start
        When the part of the log begins that is looked at.
    """

    def __init__(
        self, info: SignalInfo, reserved: Mapping[int, State], period: float | None, start: float
    ) -> None:
        self.info = info
        self._reserved = reserved
        self._longest = np.inf if period is None else GAP_PERIODS * period
        self._points = Points()
        self._marks = {mark: SpanList() for mark in Mark}
        self._states: dict[int, SpanList] = {}
        self._time = start
        self._state = int(State.VALUE)
        self._code: int | None = None

    def add(self, time: NDArray[np.float64], column: Column) -> None:
        """Take the frames of a block; what they hold is copied."""
        state, there = self._state_of(column)
        values: NDArray[Any] = column.values.astype(np.int64 if self.info.encoded else np.float64)
        if there is not None:
            time, state, values = time[there], state[there], values[there]
        if not len(time):
            return
        if not self.info.encoded:
            state = np.where(np.isfinite(values) | (state != 0), state, State.INVALID)
            good = state == State.VALUE
            self._points.add(time[good], values[good])
        self._hold(time, state, values)

    def curve(self, end: float, title: str) -> Curve:
        """The signal as a curve; the log ends at that time."""
        self._finish(end)
        time, value = self._points.points()
        marks = self._spans()
        info = self.info
        begins = begins_anew(time, list(marks.values()))
        return Curve(info.name, title, info.unit, info.factor, time, value, begins, marks)

    def band(self, end: float, title: str) -> Band:
        """The signal as a band of states; the log ends at that time."""
        self._finish(end)
        states = tuple(
            (code, self.info.labels.get(code, str(code)), spans.spans())
            for code, spans in sorted(self._states.items())
        )
        return Band(self.info.name, title, states, self._spans())

    def _spans(self) -> dict[Mark, NDArray[np.float64]]:
        spans = {mark: held.spans() for mark, held in self._marks.items()}
        return {mark: found for mark, found in spans.items() if len(found)}

    def _state_of(self, column: Column) -> tuple[NDArray[np.uint8], NDArray[np.bool_] | None]:
        """The state of each value, and which frames have the signal at all; None: all."""
        state = np.zeros(len(column.values), np.uint8)
        if column.state is not None:
            state[:] = column.state
        there = None if column.valid is None else column.valid | (state != State.VALUE)
        if self.info.encoded:
            for code, meaning in self._reserved.items():
                state[column.values == code] = meaning
        return state, None if there is None or there.all() else there

    def _hold(
        self, time: NDArray[np.float64], state: NDArray[np.uint8], values: NDArray[Any]
    ) -> None:
        """What a frame says holds until the next one, unless that is too late."""
        begins = np.append(self._time, time[:-1])
        held = np.append(np.uint8(self._state), state[:-1])
        if self._code is not None:
            codes = np.append(np.int64(self._code), values[:-1].astype(np.int64))
            self._note(codes, begins, time, held)
        elif self.info.encoded:
            self._note(values[:-1].astype(np.int64), begins[1:], time[1:], held[1:])
        self._mark(begins, time, held)
        if self.info.encoded:
            self._code = int(values[-1])
        self._time, self._state = float(time[-1]), int(state[-1])

    def _mark(
        self, begins: NDArray[np.float64], ends: NDArray[np.float64], held: NDArray[np.uint8]
    ) -> None:
        gap = ends - begins > self._longest
        for state, mark in _MARKS.items():
            own = (held == state) & ~gap
            if own.any():
                self._marks[mark].add(begins[own], ends[own])
        if gap.any():
            self._marks[Mark.GAP].add(begins[gap], ends[gap])

    def _note(
        self,
        codes: NDArray[np.int64],
        begins: NDArray[np.float64],
        ends: NDArray[np.float64],
        held: NDArray[np.uint8],
    ) -> None:
        """Note where the signal has which code; before a gap it is a mere moment."""
        ends = np.where(ends - begins > self._longest, begins, ends)
        valid = held == State.VALUE
        for code in np.unique(codes[valid]).tolist():
            own = valid & (codes == code)
            self._states.setdefault(code, SpanList()).add(begins[own], ends[own])

    def _finish(self, end: float) -> None:
        """The last frame holds to the end, unless that is too late."""
        begins, ends = np.array([self._time]), np.array([max(end, self._time)])
        held = np.array([self._state], np.uint8)
        self._mark(begins, ends, held)
        if self._code is not None:
            self._note(np.array([self._code], np.int64), begins, ends, held)
