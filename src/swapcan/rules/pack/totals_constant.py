"""The rated values of a pack do not change."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan.messages import B2V_BattInfo1, B2V_BattInfo2
from swapcan.rules.pack.silences import Silences
from swapcan.rules.shared import ANOTHER_PACK
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series
from typedcan.report.language import Text

_MESSAGES = (B2V_BattInfo1, B2V_BattInfo2)

_CHANGED = Text("{now:g}{unit}, before {before:g}{unit}", "由 {before:g}{unit} 变为 {now:g}{unit}")


class TotalsConstant(Watcher):
    """Compares each value with the last one before; 0 and codes without a value are none yet.

    What came before a silence is not compared, as it may be of another pack.
    """

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._silences = Silences(findings)
        self._last: dict[str, tuple[int, int]] = {}  # by field: value, silences before it

    def feed(self, chunk: Chunk) -> None:
        """Judge the new frames."""
        self._silences.feed(chunk)
        for message in _MESSAGES:
            series = chunk.sound(message)
            if series.fresh:
                epochs = self._silences.up_to(series.order[series.first :])
                for field in message.FIELDS:
                    self._judge(series, field, epochs)

    def _judge(self, series: Series, field: str, epochs: NDArray[np.int64]) -> None:
        raw = series.new_raw(field).astype(np.int64)
        told = np.flatnonzero((raw != 0) & ~np.isin(raw, list(series.message.FIELDS[field].states)))
        if not len(told):
            return
        raw, epochs = raw[told], epochs[told]
        value, epoch = self._last.get(field, (-1, -1))
        values = np.concatenate([[value], raw])
        same_pack = np.diff(epochs, prepend=epoch) == 0
        self._last[field] = int(raw[-1]), int(epochs[-1])
        self.findings.examine(series.message.SENDER, int(np.count_nonzero(same_pack)))
        for at in np.flatnonzero(same_pack & (values[1:] != values[:-1])).tolist():
            row = series.first + int(told[at])
            self._add(series, field, row, int(values[at]), int(values[at + 1]))

    def _add(self, series: Series, field: str, row: int, before: int, now: int) -> None:
        message, part = series.message, series.message.FIELDS[field]
        unit = f" {part.unit}" if part.unit else ""
        found = Occurrence(
            subject=Subject(message.SENDER, message.NAME, part.dbc_name),
            start=float(series.time[row]),
            end=float(series.time[row]),
            order=int(series.order[row]),
            text=_CHANGED,
            values={
                "before": before * part.factor + part.offset,
                "now": now * part.factor + part.offset,
                "unit": unit,
            },
        )
        self.findings.add(found)


RULE = Rule(
    id="totals-constant",
    title=Text("Rated values and numbers of cells do not change", "额定参数及单体总数保持不变"),
    purpose=Text(
        "What a pack is does not change while it is in use.",
        "电池系统的基本参数为非实时变化的值,使用中不应改变。",
    ),
    clause="Table 13 (5.1.12)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(ANOTHER_PACK,),
    watch=TotalsConstant,
)
