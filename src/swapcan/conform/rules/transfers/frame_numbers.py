"""Frames of cells and probes are numbered from 1, and so are their CSCs, up to their number."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Said, Subject
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.series import Series, latest
from swapcan.conform.text import Text
from typedcan.wire.protocol import FieldRef

_PARTS = tuple(
    (transfer.messages[0], transfer.group.field, transfer.frame_number.field, transfer.groups_field)
    for transfer in PROTOCOL.transfers
    if transfer.group and transfer.frame_number and transfer.groups_field
)
_NODE = _PARTS[0][0].SENDER

_BELOW = Text(
    "CSC {csc} frame {number}; both are numbered from 1",
    "CSC {csc} 帧序号 {number};两者均应从 1 开始",
)
_ABOVE = Text(
    "CSC {csc}; {totals} tells of {count}",
    "CSC {csc};{totals} 给出的总数为 {count}",
)


class FrameNumbers(Watcher):
    """Judges both numbers; the number of CSCs as soon as the pack has told it."""

    def take(self, chunk: Chunk) -> None:
        """Judge all frames of cells and probes."""
        for message, group, number, totals in _PARTS:
            series = chunk.frames(message)
            if series.fresh:
                self._judge(series, chunk.sound(totals.message), totals, group, number)

    def _judge(
        self, series: Series, told: Series, totals: FieldRef, group: str, number: str
    ) -> None:
        cscs, numbers = series.new_raw(group), series.new_raw(number)
        wrong = np.zeros(len(series), np.bool_)
        wrong[series.first :] = (cscs == 0) | (numbers == 0)
        count = _told(series, told, totals.field, cscs)
        if count is not None:
            invalid = list(series.message.FIELDS[group].states)
            wrong[series.first :] |= (cscs > count) & (count > 0) & ~np.isin(cscs, invalid)

        def describe(row: int) -> Said:
            at = row - series.first
            csc, frame = int(cscs[at]), int(numbers[at])
            if count is None or csc == 0 or frame == 0:
                return _BELOW, {"csc": csc, "number": frame}
            name = totals.message.FIELDS[totals.field].dbc_name
            return _ABOVE, {"csc": csc, "totals": name, "count": int(count[at])}

        self.findings.rows(Subject(_NODE, series.message.NAME), series, wrong, describe)


def _told(
    series: Series, told: Series, field: str, cscs: NDArray[np.unsignedinteger]
) -> NDArray[np.int64] | None:
    """How many CSCs there are, for each new row; 0 before the pack has told, None: no matter."""
    counts = told.raw(field)
    if not len(counts) or cscs.max() <= counts.min():
        return None
    known = np.concatenate([[0], counts])
    return known[latest(told, series)[series.first :] + 1]


RULE = Rule(
    id="frame-numbers",
    title=Text("CSCs and frames are numbered from 1", "CSC 编号和帧序号从 1 开始"),
    purpose=Text(
        "A receiver finds the place of a cell or probe by these numbers; tables 9 and 10 begin "
        "them at 1, and the pack tells how many CSCs it has.",
        "接收方通过这些编号确定电芯和探针的位置;表 9、表 10 规定从 1 开始,电池包给出 CSC 总数。",
    ),
    clause="Tables 9 and 10 rows 1 and 2 (5.1.8, 5.1.9); Table 13 row 6 (5.1.12)",
    severity=Severity.MUST,
    judges=(_NODE,),
    watch=FrameNumbers,
)
