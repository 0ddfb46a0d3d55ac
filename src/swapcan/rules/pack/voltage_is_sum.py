"""The pack's voltage is the sum of its cells."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from swapcan.log_protocol import CELLS
from swapcan.messages import B2V_ST3
from swapcan.rules.pack.cycles import Cycles, CycleStream, Numbers, around
from swapcan.rules.pack.history import History
from swapcan.rules.pack.runs import Runs
from swapcan.rules.shared import CYCLES_APART, TOLD_BEFORE
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_SHARE = Tolerance(
    name="voltage-is-sum.share",
    value=0.02,
    text=Text(
        "how far the voltage may lie beyond the sums of five cycles in a row, as a share: sensors "
        "of packs have 1 %, and their cells are not measured in one moment",
        "总压超出相邻五个周期单体之和的允许比例:总压传感器精度约 1 %,且各单体并非同时采样",
    ),
)
_CYCLES = Tolerance(
    name="voltage-is-sum.cycles",
    value=1,
    text=Text(
        "for how many cycles in a row it may lie further, as the load may peak between two cycles",
        "允许连续超出的周期数,因两个周期之间负载可能出现尖峰",
    ),
)

_PLAUSIBLE = 1.0, 5.0
"""V of a cell: outside, the cells that are listed are others than those between the poles."""

_LEARNING = 10
"""Cycles that show whether the pack has branches in parallel."""

_NEAR = 0.1
"""How far the ratio of branches may be from a whole number."""

_VOLTAGE = B2V_ST3.FIELDS["upack_batt"].dbc_name

_OTHER = Text(
    "the pack has {voltage:.1f} V, its {cells} cells together {total:.1f} V; allowed: "
    "{allowed:g} % off",
    "总压为 {voltage:.1f} V,{cells} 节单体之和为 {total:.1f} V;允许偏差 {allowed:g} %",
)

Rows = tuple[Numbers, NDArray[np.int64], Numbers, Numbers, NDArray[np.int64]]
"""Times and numbers of frames, voltages, sums of cells that are nearest, numbers of cells."""


class VoltageIsSum(Watcher):
    """Compares sums of cells with the voltage on the battery's side of the relays.

    Packs that list the cells of branches in parallel are not judged: those whose sums are a
    multiple of the voltage throughout the first cycles.
    """

    wants_cycles = True

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._allowed = findings.limit(_SHARE)
        self._stream = CycleStream(CELLS, findings)
        self._history = History(findings, B2V_ST3, "upack_batt")
        subject = Subject(B2V_ST3.SENDER, B2V_ST3.NAME, _VOLTAGE)
        self._runs = Runs(findings, subject, int(findings.limit(_CYCLES)) + 1)
        self._first: list[Rows] = []
        self._in_series: bool | None = None

    def feed(self, chunk: Chunk) -> None:
        """Judge the cycles that have all neighbours now."""
        self._history.feed(chunk)
        for cycles in self._stream.feed(chunk):
            if len(self._history.time):
                self._take(self._rows(cycles))

    def finish(self, end: LogEnd) -> None:
        """Judge a short log, and report what lasts to the end."""
        del end
        if self._first:
            self._decide()
        self._runs.finish()

    def _rows(self, cycles: Cycles) -> Rows:
        """What can be compared of some cycles."""
        cells = cycles.values.shape[1]
        low, high = around(cycles.values.sum(axis=1))
        rows = self._history.at(cycles.judged_at)
        voltage = self._history.value_at("upack_batt", rows)
        least, most = _PLAUSIBLE
        judged = cycles.near & cycles.surrounded
        judged &= (voltage > cells * least) & (voltage < cells * most)
        voltage, rows = voltage[judged], rows[judged]
        total = np.clip(voltage, low[judged], high[judged])
        count = np.full(len(rows), cells)
        return self._history.time[rows], self._history.order[rows], voltage, total, count

    def _take(self, rows: Rows) -> None:
        if self._in_series is None:
            self._first.append(rows)
            if sum(len(time) for time, *_ in self._first) >= _LEARNING:
                self._decide()
        elif self._in_series:
            self._judge(rows)

    def _decide(self) -> None:
        time, order, voltage, total, cells = map(np.concatenate, zip(*self._first, strict=True))
        self._first.clear()
        ratio = (total / voltage)[:_LEARNING]
        branches = np.round(ratio)
        parallel = (branches >= 2) & (np.abs(ratio / np.maximum(branches, 1) - 1) < _NEAR)
        self._in_series = not (len(ratio) and parallel.all())
        if self._in_series:
            self._judge((time, order, voltage, total, cells))

    def _judge(self, rows: Rows) -> None:
        time, order, voltage, total, cells = rows
        off = np.abs(voltage - total) / np.maximum(total, 1e-3)
        describe = partial(self._describe, voltage, total, cells)
        self._runs.feed(time, order, off > self._allowed, describe, off)

    def _describe(
        self, voltage: Numbers, total: Numbers, cells: NDArray[np.int64], row: int
    ) -> Said:
        return _OTHER, {
            "voltage": float(voltage[row]),
            "cells": int(cells[row]),
            "total": float(total[row]),
            "allowed": 100 * self._allowed,
        }


RULE = Rule(
    id="voltage-is-sum",
    title=Text("The pack's voltage is the sum of its cells", "电池端总压等于各单体电压之和"),
    purpose=Text(
        "Precharging and charging go by the pack's voltage; the cells tell whether it is right.",
        "预充和充电以电池端总压为依据;单体电压之和可验证其正确性。",
    ),
    clause="Table 1 row 4 (5.1.1), Table 9 (5.1.8)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    tolerances=(_SHARE, _CYCLES, CYCLES_APART, TOLD_BEFORE),
    watch=VoltageIsSum,
)
