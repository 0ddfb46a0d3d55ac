"""Watches the cycles in which cells and probes are sent."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings, Subject
from swapcan.conform.measure.steps import frame_of_cycle, key_of
from swapcan.conform.rule import Watcher
from swapcan.conform.rules.transfers.turn_order import CycleLearner, Learner, Rows
from swapcan.conform.rules.transfers.turn_watch import TurnWatcher
from swapcan.conform.rules.transfers.turns import Kind
from swapcan.conform.text import Text
from swapcan.conform.tolerance import Tolerance
from typedcan.wire.protocol import Transfer

MISSING_OR_DOUBLED: Mapping[Kind, Text] = {
    Kind.MISSING: Text(
        "missing in a cycle of {size} frames",
        "在 {size} 帧的周期中缺失",
    ),
    Kind.DOUBLED: Text(
        "came twice in a cycle of {size} frames",
        "在 {size} 帧的周期中出现两次",
    ),
}
"""What is to be complete."""

OUT_OF_ORDER: Mapping[Kind, Text] = {
    Kind.LATE: Text(
        "came after a frame that follows it in a cycle of {size} frames",
        "在 {size} 帧的周期中晚于其后的帧",
    ),
    Kind.UNSORTED: Text(
        "comes after a higher number in each cycle of {size} frames",
        "在每个 {size} 帧的周期中排在较大编号之后",
    ),
}
"""What is to be in order."""


def pause_of(rule: str) -> Tolerance:
    """How long a pause cuts a cycle off, for a rule."""
    return Tolerance(
        name=f"{rule}.periods",
        value=5.0,
        text=Text(
            "Periods without a frame after which what comes is a new beginning, be it of a "
            "restarted node or of another pack",
            "超过该周期数没有报文时,其后的报文视为重新开始(节点重启或更换电池包)",
        ),
    )


def watcher(
    transfer: Transfer, pause: Tolerance, texts: Mapping[Kind, Text]
) -> Callable[[Findings], Watcher]:
    """What watches a transfer whose frames have a number within a CSC."""
    return partial(CycleWatcher, transfer=transfer, pause=pause, texts=texts)


class CycleWatcher(TurnWatcher):
    """Follows the frames of all CSCs.

    Parameters
    ----------
    transfer
        What they carry.
    pause
        How many periods without a frame cut a cycle off.
    texts
        What to say of which faults.
    """

    def __init__(
        self,
        findings: Findings,
        *,
        transfer: Transfer,
        pause: Tolerance,
        texts: Mapping[Kind, Text],
    ) -> None:
        self._message = message = transfer.messages[0]
        seconds = findings.limit(pause) * (message.PERIOD or 0.0)
        super().__init__(findings, node=message.SENDER, pause=seconds, texts=texts)

    def _new_learner(self) -> Learner:
        return CycleLearner()

    def _new_rows(self, chunk: Chunk) -> Rows:
        series = chunk.frames(self._message)
        return Rows(key_of(series), series.time[series.first :], series.order[series.first :])

    def _subject(self, key: int) -> Subject:
        message = self._message
        return Subject(message.SENDER, message.NAME, detail=frame_of_cycle(key))
