"""The main positive relay closes only after a precharge."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST0, B2V_ST1, BmsState, RelayState
from swapcan.rules.voltage.charge_path import ChargePath
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.last_known import LastKnown, fresh_for
from typedcan.judge.measure.since import Since, last
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_WATCHED = Tolerance(
    name="precharge-first.watched",
    value=0.5,
    unit="s",
    text=Text(
        "before the main positive relay closes for which the log has to show it open",
        "主正继电器闭合前,日志中应显示其断开的时间",
    ),
)
_ROUNDING = 1e-6  # s, of time stamps

_SUBJECT = Subject("BMU", "B2V_ST0", "B2V_ST0_ST_MainPos")

_MISSING = Text(
    "main positive relay closes without precharge: in the {seconds:.2f} s for which it was seen "
    "open, neither the precharge relay was closed nor the state Precharge",
    "主正继电器未经预充即闭合:其断开的 {seconds:.2f} s 内,预充继电器未闭合,状态也非 Precharge",
)


class PrechargeFirst(Watcher):
    """Looks back from each closing of the main positive relay."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._watched = findings.limit(_WATCHED) - _ROUNDING
        self._path = ChargePath()
        self._open = Since(fresh_for(B2V_ST0, findings))
        # Orders of the last frames, as floats; -1: none.
        self._closed = self._precharged = self._told = -1.0

    def feed(self, chunk: Chunk) -> None:
        """Judge the closings of the main positive relay."""
        relays, states = chunk.sound(B2V_ST0), chunk.sound(B2V_ST1)
        positive, precharge = relays.raw("st_main_pos"), relays.raw("st_prechg")
        for_charging = self._path.feed(chunk)["st_main_pos"]
        is_open = positive == RelayState.OPEN
        opened = self._open.feed(relays, is_open)
        closed = self._last(relays, positive == RelayState.CLOSED, self._closed)
        precharged = self._last(relays, precharge == RelayState.CLOSED, self._precharged)
        told = self._last(states, states.raw("bms") == BmsState.PRECHARGE, self._told)
        closes = np.flatnonzero(is_open[:-1] & (positive[1:] == RelayState.CLOSED)) + 1
        if len(closes):
            state = LastKnown(states, relays)
            shown = state.known | (precharge == RelayState.OPEN)
            for row in closes.tolist():
                seconds = float(relays.time[row - 1] - opened[row - 1])
                step = float(relays.time[row] - relays.time[row - 1])
                if (
                    step > relays.lasts
                    or seconds < self._watched
                    or not shown[row]
                    or for_charging[row - 1]
                ):
                    continue
                proof = float(precharged[row])
                if len(told) and states.order[state.rows[row]] < relays.order[row]:
                    proof = max(proof, float(told[state.rows[row]]))
                self._judge(relays, row, seconds + step, precharged=proof > float(closed[row - 1]))
        self._closed, self._precharged, self._told = (
            float(each[-1]) if len(each) else before
            for each, before in (
                (closed, self._closed),
                (precharged, self._precharged),
                (told, self._told),
            )
        )

    @staticmethod
    def _last(series: Series, holds: NDArray[np.bool_], before: float) -> NDArray[np.float64]:
        """The order of the last frame, for each row, at which something was so."""
        return last(series, holds, series.order.astype(np.float64), before)

    def _judge(self, relays: Series, row: int, seconds: float, *, precharged: bool) -> None:
        self.findings.examine("BMU")
        if not precharged:
            self.findings.add(
                Occurrence(
                    subject=_SUBJECT,
                    start=float(relays.time[row]),
                    end=float(relays.time[row]),
                    order=int(relays.order[row]),
                    measure=1.0,
                    text=_MISSING,
                    values={"seconds": seconds},
                )
            )


RULE = Rule(
    id="precharge-first",
    title=Text("Main positive closes after precharge", "预充后才闭合主正继电器"),
    purpose=Text(
        "High voltage is switched on once precharge is done: without it the inrush current welds "
        "the relay.",
        "预充完成后才进入高压上电状态;未经预充,冲击电流会使继电器粘连。",
    ),
    clause="5.2.1.1, Table 2 rows 1 and 3 (5.1.2)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_WATCHED,),
    watch=PrechargeFirst,
)
