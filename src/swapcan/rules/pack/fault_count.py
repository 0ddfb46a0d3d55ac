"""No more faults are counted than alarms are raised."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_ST0, B2V_ST1
from swapcan.rules.pack.alarm_watcher import AlarmWatcher
from swapcan.rules.pack.alarms import Alarms, alarm_bits
from swapcan.rules.shared import AROUND
from typedcan.judge.findings import Said
from typedcan.judge.rule import Rule, Severity
from typedcan.report.language import Text

_MORE = Text(
    "faults counted: {number}, alarms raised: {raised}",
    "故障数目为 {number},实际存在的报警仅 {raised} 项",
)


class FaultCount(AlarmWatcher):
    """Compares the number with the alarms of the same frame and of any B2V_ST0 around it.

    It counts those faults that GB/T 32960.3 lists, which are not told apart here: fewer are right.
    """

    field = "gbt32960_flt_num"

    def judge(self, alarms: Alarms) -> None:
        """Judge frames around which all is known."""
        own, other = alarm_bits(B2V_ST1), alarm_bits(B2V_ST0)
        known = alarms.known
        number = alarms.number[known]
        raised = (own.count(alarms.own) + other.count(alarms.any_around))[known]
        self.runs.feed(
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
    tolerances=(AROUND,),
    watch=FaultCount,
)
