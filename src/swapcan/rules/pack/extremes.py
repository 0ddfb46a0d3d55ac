"""What is the same for cell voltages and probe temperatures: their extremes, and where they are."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from swapcan.log_protocol import CELLS, PROBES
from swapcan.messages import B2V_ST4, B2V_ST5, B2V_ST6
from swapcan.rules.pack.cycles import SIDE, Cycles, CycleStream, Numbers, around
from swapcan.rules.pack.history import History
from swapcan.rules.pack.runs import ROUNDING, Runs
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.logs.transfers.readings import Readings
from typedcan.report.language import Text
from typedcan.wire.message import Message


@dataclass(frozen=True, slots=True)
class Told:
    """An extreme that a pack tells: by which fields of which message, and whether the highest."""

    message: type[Message]
    value: str
    csc: str
    position: str
    highest: bool

    def name(self, field: str) -> str:
        """The standard's name of a field."""
        return self.message.FIELDS[field].dbc_name

    @property
    def word(self) -> Text:
        """Which of the two it is."""
        return Text("highest", "最高") if self.highest else Text("lowest", "最低")


@dataclass(frozen=True, slots=True)
class Kind:
    """Cells or probes: what is read, the extremes that are told, and in what they are shown."""

    readings: Readings
    told: tuple[Told, ...]
    item: Text
    unit: Text
    digits: int

    def shown(self, value: float, form: str = "") -> Text:
        """A value with its unit, rounded to what is sent unless another form is given."""
        number = format(value, form or f".{self.digits}f")
        return Text(f"{number} {self.unit.en}", f"{number} {self.unit.zh}")


CELL_VOLTAGES = Kind(
    CELLS,
    (
        Told(B2V_ST5, "max_ucell", "max_ucell_csc_no", "max_ucell_position", highest=True),
        Told(B2V_ST6, "min_ucell", "min_ucell_csc_no", "min_ucell_position", highest=False),
    ),
    Text("cell", "电芯"),
    Text("V", "V"),
    3,
)
"""Table 6 beside table 9."""

PROBE_TEMPERATURES = Kind(
    PROBES,
    (
        Told(B2V_ST4, "max_temp", "max_temp_csc_no", "max_temp_position", highest=True),
        Told(B2V_ST4, "min_temp", "min_temp_csc_no", "min_temp_position", highest=False),
    ),
    Text("probe", "探针"),
    Text("degC", "℃"),
    0,
)
"""Table 7 beside table 10."""

_UNEQUAL = Text(
    "{told} is told, the {word} in {message} is {right}; allowed: {allowed} off",
    "上报值为 {told},{message} 中的{word}值为 {right};允许偏差 {allowed}",
)
_ELSEWHERE = Text(
    "CSC {csc} {item} {position} is told to be the {word}, but has {there}: the {word} has "
    "{extreme}; allowed: {allowed} off",
    "所报{word}值位于 CSC {csc} 第 {position} 号{item},但其值为 {there}:实际{word}值为 {extreme};"
    "允许偏差 {allowed}",
)
_NOWHERE = Text(
    "CSC {csc} {item} {position} is told to be the {word}, but {message} has none of that number",
    "所报{word}值位于 CSC {csc} 第 {position} 号{item},但 {message} 中没有该编号",
)


class _Extremes(Watcher):
    """Holds extremes that are told against the cycles."""

    wants_cycles = True

    def __init__(
        self, findings: Findings, kind: Kind, allowed: Tolerance, lasting: Tolerance, about: str
    ) -> None:
        super().__init__(findings)
        self.kind = kind
        self.allowed = findings.limit(allowed)
        self._stream = CycleStream(kind.readings, findings)
        self._told: list[tuple[Told, History, Runs]] = []
        for told in kind.told:
            history = History(findings, told.message, told.value, raw=(told.csc, told.position))
            signal = told.name(told.value if about == "value" else told.position)
            subject = Subject(told.message.SENDER, told.message.NAME, signal)
            runs = Runs(findings, subject, int(findings.limit(lasting)) + 1)
            self._told.append((told, history, runs))

    def feed(self, chunk: Chunk) -> None:
        """Judge the cycles that have all neighbours now."""
        for _, history, _ in self._told:
            history.feed(chunk)
        for cycles in self._stream.feed(chunk):
            for told, history, runs in self._told:
                if len(history.time):
                    self.judge(told, cycles, history, runs)

    def finish(self, end: LogEnd) -> None:
        """Report what lasts to the end."""
        del end
        for _, _, runs in self._told:
            runs.finish()

    def judge(self, told: Told, cycles: Cycles, history: History, runs: Runs) -> None:
        """Judge one of the extremes."""
        raise NotImplementedError


class ExtremesEqual(_Extremes):
    """Compares extremes that are told with those of the single readings.

    Parameters
    ----------
    allowed
        How far they may be apart.
    lasting
        For how many cycles they may.
    """

    def __init__(
        self, findings: Findings, *, kind: Kind, allowed: Tolerance, lasting: Tolerance
    ) -> None:
        super().__init__(findings, kind, allowed, lasting, "value")

    def judge(self, told: Told, cycles: Cycles, history: History, runs: Runs) -> None:
        """Judge one of the extremes."""
        rows = history.at(cycles.judged_at)
        value = history.value_at(told.value, rows)
        low, high = _limits(told, cycles)
        judged = cycles.near & ~np.isnan(value) & ~np.isnan(low) & ~np.isnan(high)
        low, high, value, rows = low[judged], high[judged], value[judged], rows[judged]
        excess = np.maximum(value - high, low - value)
        runs.feed(
            history.time[rows],
            history.order[rows],
            excess > self.allowed + ROUNDING,
            partial(self._describe, told, value, low, high),
            excess,
        )

    def _describe(self, told: Told, value: Numbers, low: Numbers, high: Numbers, row: int) -> Said:
        shown = self.kind.shown
        return _UNEQUAL, {
            "told": shown(value[row]),
            "message": self.kind.readings.message,
            "word": told.word,
            "right": shown(low[row] if value[row] < low[row] else high[row]),
            "allowed": shown(self.allowed, "g"),
        }


@dataclass(frozen=True, slots=True)
class _Seen:
    """Places that are told, the values there, the extremes, and how far these are apart."""

    csc: NDArray[np.int64]
    position: NDArray[np.int64]
    there: Numbers
    extreme: Numbers
    off: Numbers


class ExtremesPlace(_Extremes):
    """Looks up the reading that is told to be the extreme.

    Parameters
    ----------
    allowed
        How far its value may be from the extreme.
    lasting
        For how many cycles it may be further.
    """

    def __init__(
        self, findings: Findings, *, kind: Kind, allowed: Tolerance, lasting: Tolerance
    ) -> None:
        super().__init__(findings, kind, allowed, lasting, "position")

    def judge(self, told: Told, cycles: Cycles, history: History, runs: Runs) -> None:
        """Judge one of the places; one whose reading has no value is not judged.

        A value that is no extreme is another rule's: the extreme has to be at the place then.
        """
        rows = history.at(cycles.judged_at)
        value = history.value_at(told.value, rows)
        low, high = _limits(told, cycles)
        extreme = np.minimum(np.maximum(value, low), high)
        csc, position = history.raw[told.csc][rows], history.raw[told.position][rows]
        judged = cycles.near & ~np.isnan(extreme)
        for code in told.message.FIELDS[told.csc].states:
            judged &= csc != code
        at = np.flatnonzero(judged) + SIDE
        column = _columns(cycles.positions)[csc[judged] << 8 | position[judged]]
        there, off = self._off(cycles, at, column, extreme[judged])
        known = (column < 0) | ~np.isnan(there)
        judged[judged] = known
        rows, off = rows[judged], off[known]
        seen = _Seen(csc[judged], position[judged], there[known], extreme[judged], off)
        runs.feed(
            history.time[rows],
            history.order[rows],
            off > self.allowed + ROUNDING,
            partial(self._describe, told, seen),
            off,
        )

    def _off(
        self, cycles: Cycles, at: NDArray[np.int64], column: NDArray[np.int64], extreme: Numbers
    ) -> tuple[Numbers, Numbers]:
        """The readings of some columns, and how far they are off; infinite without a column."""
        there = cycles.values[at, column]
        off = np.abs(there - extreme)
        (unlike,) = np.nonzero(off > self.allowed)
        near = cycles.values[at[unlike] + np.arange(-SIDE, SIDE + 1)[:, None], column[unlike]]
        low, high = np.fmin.reduce(near, axis=0), np.fmax.reduce(near, axis=0)
        off[unlike] = np.maximum(np.maximum(low - extreme[unlike], extreme[unlike] - high), 0.0)
        off[column < 0] = np.inf
        return there, off

    def _describe(self, told: Told, seen: _Seen, row: int) -> Said:
        said = {
            "csc": int(seen.csc[row]),
            "position": int(seen.position[row]),
            "item": self.kind.item,
            "word": told.word,
        }
        if np.isinf(seen.off[row]):
            return _NOWHERE, {**said, "message": self.kind.readings.message}
        shown = self.kind.shown
        return _ELSEWHERE, {
            **said,
            "there": shown(seen.there[row]),
            "extreme": shown(seen.extreme[row]),
            "allowed": shown(self.allowed, "g"),
        }


def _limits(told: Told, cycles: Cycles) -> tuple[Numbers, Numbers]:
    """Between what an extreme may be; one without a value may be beyond all others."""
    low, high = around(cycles.extremes(highest=told.highest))
    if told.highest:
        return low, np.where(cycles.surrounded, high, np.inf)
    return np.where(cycles.surrounded, low, -np.inf), high


@cache
def _columns(positions: tuple[tuple[int, int], ...]) -> NDArray[np.int64]:
    """The column of each reading by its CSC and, in the low byte, its number; -1 for none."""
    columns = np.full(1 << 16, -1, np.int64)
    for column, (csc, number) in enumerate(positions):
        columns[csc << 8 | number] = column
    return columns
