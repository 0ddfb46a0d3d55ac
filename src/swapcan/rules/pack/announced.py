"""How many CSCs and readings a pack announces, beside how many it sends."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST1, B2V_BattInfo2
from swapcan.rules.pack.silences import Silences
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Watcher
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.message import Message

_KEYS = 1 << 16
"""CSCs and frame numbers in one."""

_SLOTS = 8
"""More than the readings of a frame."""

_UNMEASURED = ("flt_hw", "flt_local_comm")
"""The alarms of B2V_ST1 that explain why a reading has no value."""

_OTHER = Text(
    "{announced} announced, {message} carries {carried}",
    "上报总数为 {announced},{message} 实际包含 {carried}",
)
_BEYOND = Text(
    "{announced} announced, {message} carries {carried} with a value and room for {most}",
    "上报总数为 {announced},{message} 中有效值 {carried} 个,最多可容纳 {most} 个",
)


@dataclass(frozen=True, slots=True)
class Carried:
    """What the frames of one message carried: with a value, and including what may have none."""

    cscs: tuple[int, int]
    readings: tuple[int, int]


Counted = Callable[[Carried], tuple[int, int]]
"""What of it an announced total is to be compared with."""


class Announced(Watcher):
    """Counts what one message carries of each CSC over the log, and compares at its end.

    It judges where each frame came twice, so that none is still to come. The highest reading with
    a value of each CSC counts: codes without a value behind it fill up the last frame. Only where
    the pack announces that something is not measured may they be readings. What came before a
    silence is judged apart, as it may be of another pack. Where no two CSCs have a frame number in
    common the numbers run on through the pack, as E50 reads them otherwise.

    Parameters
    ----------
    message
        What carries the readings.
    totals
        Fields of `B2V_BattInfo2`, and what each of them has to equal.
    seconds
        How long the message must have been seen.
    """

    def __init__(
        self,
        findings: Findings,
        *,
        message: type[Message],
        totals: Mapping[str, Counted],
        seconds: Tolerance,
    ) -> None:
        super().__init__(findings)
        self._message = message
        self._totals = totals
        self._seconds = findings.limit(seconds)
        self._silences = Silences(findings)
        self._epoch = 0
        self._begin()

    def feed(self, chunk: Chunk) -> None:
        """Note what the frames carry."""
        self._silences.feed(chunk)
        readings, totals = chunk.frames(self._message), chunk.sound(B2V_BattInfo2)
        status = chunk.sound(B2V_ST1)
        for epoch in range(self._epoch, self._silences.count + 1):
            if epoch > self._epoch:
                self._conclude()
                self._begin()
                self._epoch = epoch
            self._note_readings(readings, self._rows(readings))
            self._note_totals(totals, self._rows(totals))
            rows = self._rows(status)
            self._unmeasured |= any(status.new_raw(name)[rows].any() for name in _UNMEASURED)

    def finish(self, end: LogEnd) -> None:
        """Compare, where the message was seen long enough."""
        del end
        self._conclude()

    def _begin(self) -> None:
        self._seen = np.zeros(_KEYS * _SLOTS, np.bool_)
        self._times = np.zeros(_KEYS, np.int64)
        self._first, self._last = np.inf, -np.inf
        self._unmeasured = False
        self._told: dict[str, tuple[int, float, int]] = {}

    def _rows(self, series: Series) -> slice | NDArray[np.int64]:
        """The new rows since the last silence, up to the next."""
        if not self._silences.is_new:
            return slice(None)
        epochs = self._silences.up_to(series.order[series.first :])
        return np.flatnonzero(epochs == self._epoch)

    def _note_readings(self, series: Series, rows: slice | NDArray[np.int64]) -> None:
        time = series.time[series.first :][rows]
        if not len(time):
            return
        self._first = min(self._first, float(time.min()))
        self._last = max(self._last, float(time.max()))
        number, csc, *items = self._message.FIELDS
        highest = np.zeros(len(time), np.uint8)
        for place, item in enumerate(items, 1):
            (without,) = self._message.FIELDS[item].states
            highest[series.new_raw(item)[rows] != without] = place
        code = series.new_raw(csc)[rows].astype(np.int32) << 8
        code |= series.new_raw(number)[rows]
        self._times += np.bincount(code, minlength=_KEYS)
        self._seen[code * _SLOTS + highest] = True

    def _note_totals(self, series: Series, rows: slice | NDArray[np.int64]) -> None:
        time, order = series.time[series.first :][rows], series.order[series.first :][rows]
        if len(time):
            for field in self._totals:
                if number := int(series.new_raw(field)[rows][-1]):
                    self._told[field] = number, float(time[-1]), int(order[-1])

    def _conclude(self) -> None:
        numbered = self._times.reshape(256, 256)[1:255, 1:]
        once = (numbered == 1).any()  # there may be frames that have not come yet
        if once or not self._told or not self._last - self._first >= self._seconds:
            return
        carried = self._carried()
        for field, (number, time, order) in self._told.items():
            least, most = self._totals[field](carried)
            most = most if self._unmeasured else least
            node = B2V_BattInfo2.SENDER
            self.findings.examine(node)
            if not least <= number <= most:
                name = B2V_BattInfo2.FIELDS[field].dbc_name
                found = Occurrence(
                    subject=Subject(node, B2V_BattInfo2.NAME, name),
                    start=time,
                    end=time,
                    order=order,
                    measure=float(abs(number - least)),
                    text=_OTHER if least == most else _BEYOND,
                    values={
                        "announced": number,
                        "message": self._message.NAME,
                        "carried": least,
                        "most": most,
                    },
                )
                self.findings.add(found)

    def _carried(self) -> Carried:
        _, csc, *items = self._message.FIELDS
        width = len(items)
        seen = self._seen.reshape(256, 256, _SLOTS)[:, 1:]
        numbered = np.arange(255)[:, None] * width
        highest = np.where(seen[:, :, 1:], numbered + np.arange(1, _SLOTS), 0).max(axis=(1, 2))
        room = np.where(seen.any(axis=2), numbered[:, 0] + width, 0).max(axis=1)
        none = [0, *self._message.FIELDS[csc].states]
        highest[none] = room[none] = 0
        shared = np.delete(seen.any(axis=2), none, axis=0).sum(axis=0) > 1
        if not shared.any():
            return Carried(
                (int(np.count_nonzero(highest)), int(np.count_nonzero(room))),
                (int(highest.max()), int(room.max())),
            )
        return Carried(
            (int(np.count_nonzero(highest)), int(np.count_nonzero(room))),
            (int(highest.sum()), int(room.sum())),
        )
