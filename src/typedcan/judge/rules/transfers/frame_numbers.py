"""Frames of cells and probes are numbered from 1, and so are their CSCs, up to their number."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Said, Subject
from typedcan.judge.measure.steps import keyed
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.series import Series, latest
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import FieldRef, Protocol

Part = tuple[type[Message], str, str, FieldRef]
"""A message, its fields of the group and of the frame number, and what tells how many groups."""

_BELOW = Text(
    "CSC {csc} frame {number}; both are numbered from 1",
    "CSC {csc} 帧序号 {number};两者均应从 1 开始",
)
_ABOVE = Text(
    "CSC {csc}; {totals} tells of {count}",
    "CSC {csc};{totals} 给出的总数为 {count}",
)


class FrameNumbers(Watcher):
    """Judges both numbers; that of groups as soon as it is announced how many there are."""

    def __init__(self, findings: Findings, parts: Sequence[Part]) -> None:
        super().__init__(findings)
        self._parts = parts

    def feed(self, chunk: Chunk) -> None:
        """Judge all frames with such numbers."""
        for message, group, number, totals in self._parts:
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

        subject = Subject(series.message.SENDER, series.message.NAME)
        self.findings.rows(subject, series, wrong, describe)


def _told(
    series: Series, told: Series, field: str, cscs: NDArray[np.unsignedinteger]
) -> NDArray[np.int64] | None:
    """How many CSCs there are, for each new row; 0 before the pack has told, None: no matter."""
    counts = told.raw(field)
    if not len(counts) or cscs.max() <= counts.min():
        return None
    known = np.concatenate([[0], counts])
    return known[latest(told, series)[series.first :] + 1]


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    parts = tuple(
        (message, group, number, transfer.groups_field)
        for transfer in protocol.transfers
        for message, (group, number) in keyed(protocol).items()
        if message is transfer.messages[0] and transfer.groups_field
        if (transfer.parts.transfer.first_group, transfer.parts.transfer.first_number) == (1, 1)
    )
    return Rule(
        id="frame-numbers",
        title=Text("Groups and frames are numbered from 1", "分组编号和帧序号从 1 开始"),
        purpose=Text(
            "A receiver finds the place of a reading by these numbers.",
            "接收方通过这些编号确定数据的位置。",
        ),
        severity=Severity.MUST,
        judges=tuple(dict.fromkeys(message.SENDER for message, *_ in parts)),
        watch=partial(FrameNumbers, parts=parts),
    )
