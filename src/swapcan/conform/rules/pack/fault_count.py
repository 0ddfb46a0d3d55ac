"""No more faults are counted than alarms are raised."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings, Said, Subject
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.pack.alarms import Alarms, AlarmStream, alarm_bits
from swapcan.conform.rules.pack.runs import Runs
from swapcan.conform.text import Text
from swapcan.messages import B2V_ST0, B2V_ST1

_MORE = Text(
    "faults counted: {number}, alarms raised: {raised}",
    "故障数目为 {number},实际存在的报警仅 {raised} 项",
)


class FaultCount(Watcher):
    """Compares the number with the alarms of the same frame and of any B2V_ST0 around it.

    It counts those faults that GB/T 32960.3 lists, which are not told apart here: fewer are right.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._stream = AlarmStream()
        signal = B2V_ST1.FIELDS["gbt32960_flt_num"].dbc_name
        self._runs = Runs(findings, Subject(B2V_ST1.SENDER, B2V_ST1.NAME, signal))

    def take(self, chunk: Chunk) -> None:
        """Judge the frames around which all is known."""
        self._judge(self._stream.take(chunk))

    def finish(self, end: float) -> None:
        """Judge the rest."""
        del end
        if left := self._stream.finish():
            self._judge(left)
        self._runs.finish()

    def _judge(self, alarms: Alarms) -> None:
        own, other = alarm_bits(B2V_ST1), alarm_bits(B2V_ST0)
        known = alarms.known
        number = alarms.number[known]
        raised = (own.count(alarms.own) + other.count(alarms.any_around))[known]
        self._runs.take(
            alarms.time[known],
            alarms.order[known],
            number > raised,
            partial(_describe, number, raised),
            (number - raised).astype(np.float64),
        )


def _describe(number: NDArray[np.int64], raised: NDArray[np.int64], row: int) -> Said:
    return _MORE, {"number": int(number[row]), "raised": int(raised[row])}


RULE = Rule(
    id="fault-count",
    title=Text("No more faults are counted than alarms are raised", "故障数目不多于报警项数"),
    purpose=Text(
        "The number is forwarded to the supervising platform beside the alarms.",
        "故障数目与各项报警一并上传监管平台。",
    ),
    clause="Table 1 row 16 (5.1.1), Table 2 (5.1.2), Table 12 (5.1.11)",
    severity=Severity.SHOULD,
    judges=("BMU",),
    watch=FaultCount,
)
