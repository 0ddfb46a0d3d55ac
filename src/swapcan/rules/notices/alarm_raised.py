"""The alarms of tables 2 and 12 that a pack raises."""

from __future__ import annotations

from functools import partial

import numpy as np

from swapcan.messages import B2V_ST0, B2V_ST1
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.lasting import Lasting, LastingWatcher
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.series import Series
from typedcan.report.language import Text
from typedcan.wire.message import Message

_ALARMS: tuple[tuple[type[Message], str], ...] = tuple(
    (message, field)
    for message in (B2V_ST0, B2V_ST1)
    for field in message.FIELDS
    if field.startswith("flt_")
)

_FAULT = Text("fault", "故障")
_LEVELS = {
    1: Text("level 1, light", "1 级(轻微)"),
    2: Text("level 2, more severe", "2 级(较严重)"),
    3: Text("level 3, most severe", "3 级(最严重)"),
}

_RAISED = Text(
    "{alarm}: {level}, for {seconds:.1f} s",
    "{signal}:{level},持续 {seconds:.1f} s",
)


class AlarmRaised(LastingWatcher):
    """Looks for alarms that are not normal."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._raised = {alarm: self.lasting(_subject(*alarm), None, alarm[0]) for alarm in _ALARMS}

    def feed(self, chunk: Chunk) -> None:
        """Tell of all alarms."""
        for (message, field), raised in self._raised.items():
            series = chunk.sound(message)
            if raised.open or series.new_raw(field).any():
                self._tell(series, field, raised)
            else:
                self.findings.examine("BMU", series.fresh)

    @staticmethod
    def _tell(series: Series, field: str, raised: Lasting) -> None:
        level = series.raw(field)
        raised.feed(series, None, level > 0, partial(_describe, series, field), level)


def _subject(message: type[Message], field: str) -> Subject:
    return Subject("BMU", message.NAME, message.FIELDS[field].dbc_name)


def _describe(series: Series, field: str, row: int) -> Said:
    part = series.message.FIELDS[field]
    level = _FAULT if part.length == 1 else _LEVELS[int(np.take(series.raw(field), row))]
    return _RAISED, {"alarm": part.title, "signal": part.dbc_name, "level": level}


RULE = Rule(
    id="alarm-raised",
    title=Text("Alarms of the pack", "电池包报警"),
    purpose=Text(
        "The standard is kept where a pack tells of a fault; the fault is worth knowing.",
        "电池包上报故障本身符合标准,但故障内容值得关注。",
    ),
    clause="Table 2 rows 9 to 25 (5.1.2), Table 12 (5.1.11)",
    severity=Severity.INFO,
    judges=("BMU",),
    watch=AlarmRaised,
)
