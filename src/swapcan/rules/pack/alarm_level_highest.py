"""The highest alarm level is that of the single alarms."""

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

_HIGHEST = 3

_LOW = Text(
    "level {level}, but {alarm} is raised: at least {least}",
    "等级为 {level},但存在 {alarm}:应不低于 {least}",
)
_HIGH = Text(
    "level {level}, but no alarm is above {most}",
    "等级为 {level},但各项报警等级均不高于 {most}",
)


class AlarmLevelHighest(AlarmWatcher):
    """Compares the level with the alarms of the same frame, and with those of B2V_ST0 around it.

    An alarm of one bit has no level: the highest is at least 1 then, and may be any.
    """

    field = "fault_levl"

    def judge(self, alarms: Alarms) -> None:
        """Judge frames around which all is known."""
        own, other = alarm_bits(B2V_ST1), alarm_bits(B2V_ST0)
        own_highest, own_flag = own.highest(alarms.own), own.has_flag(alarms.own)
        least = np.maximum(own_highest, other.highest(alarms.all_around))
        least = np.maximum(least, own_flag | other.has_flag(alarms.all_around))
        most = np.maximum(own_highest, other.highest(alarms.any_around))
        most[own_flag | other.has_flag(alarms.any_around) | ~alarms.known] = _HIGHEST
        wrong = (alarms.level < least) | (alarms.level > most)
        describe = partial(_describe, alarms, least, most)
        self.runs.feed(alarms.time, alarms.order, wrong, describe)


def _describe(alarms: Alarms, least: NDArray[np.int64], most: NDArray[np.int64], row: int) -> Said:
    level = int(alarms.level[row])
    if level > most[row]:
        return _HIGH, {"level": level, "most": int(most[row])}
    raised = alarm_bits(B2V_ST1).raised(int(alarms.own[row]))
    raised |= alarm_bits(B2V_ST0).raised(int(alarms.all_around[row]))
    gravest = max(raised, key=raised.__getitem__)
    return _LOW, {"level": level, "alarm": gravest, "least": int(least[row])}


RULE = Rule(
    id="alarm-level-highest",
    title=Text(
        "The highest alarm level is that of the single alarms", "最高报警等级与各项报警一致"
    ),
    purpose=Text(
        "The VCU cuts power and stops by the highest level.",
        "VCU 依据最高报警等级降功率或停车。",
    ),
    clause="Table 1 row 15 (5.1.1), Table 2 (5.1.2), Table 12 (5.1.11)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(AROUND,),
    watch=AlarmLevelHighest,
)
