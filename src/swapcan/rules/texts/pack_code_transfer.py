"""The pack code comes whole: all four messages in each round."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from swapcan._generated.protocol import PROTOCOL
from swapcan.transfer.text import PACK_CODE
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Subject
from typedcan.judge.rule import Rule, Severity
from typedcan.judge.rules.transfers.turn_order import Learner, Rows, TurnOrder
from typedcan.judge.rules.transfers.turn_watch import TurnWatcher
from typedcan.judge.rules.transfers.turns import Kind
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_PERIODS = Tolerance(
    name="pack-code-transfer.periods",
    value=5.0,
    text=Text(
        "Periods without a frame after which what comes is a new beginning",
        "超过该周期数没有报文时,其后的报文视为重新开始",
    ),
)

_TEXTS: Mapping[Kind, Text] = {
    Kind.MISSING: Text(
        "missing in a round of the {size} messages", "在 {size} 条报文的一轮发送中缺失"
    ),
    Kind.DOUBLED: Text(
        "came twice in a round of the {size} messages", "在 {size} 条报文的一轮发送中出现两次"
    ),
}

_MESSAGES = PACK_CODE.messages
_NODE = _MESSAGES[0].SENDER
_PERIOD = _MESSAGES[0].PERIOD or 0.0
_REQUEST = next(each for each in PROTOCOL.requests if _MESSAGES[0] in each.answers)


class PackCodeTransfer(TurnWatcher):
    """Follows the rounds between a request and its withdrawal, which may cut the last one off."""

    def __init__(self, findings: Findings) -> None:
        pause = findings.limit(_PERIODS) * _PERIOD
        super().__init__(findings, node=_NODE, pause=pause, texts=_TEXTS)

    def _new_learner(self) -> Learner:
        return _RoundLearner()

    def _new_rows(self, chunk: Chunk) -> Rows:
        every = [chunk.frames(message) for message in _MESSAGES]
        orders = np.concatenate([series.order[series.first :] for series in every])
        times = np.concatenate([series.time[series.first :] for series in every])
        numbers = np.arange(1, len(every) + 1, dtype=np.uint16)
        keys = np.repeat(numbers, [series.fresh for series in every])
        by_order = np.argsort(orders)
        return Rows(keys[by_order], times[by_order], orders[by_order])

    def _cuts(self, chunk: Chunk, new: Rows) -> NDArray[np.bool_]:
        cuts = super()._cuts(chunk, new)
        series = chunk.sound(_REQUEST.field.message)
        if series.fresh:
            not_asked = series.raw(_REQUEST.field.field) != _REQUEST.code
            not_asked[: series.first] = False
            cuts[np.searchsorted(new.orders, series.order[not_asked])] = True
        return cuts

    def _subject(self, key: int) -> Subject:
        return Subject(_NODE, _MESSAGES[key - 1].NAME)


class _RoundLearner(Learner):
    """Takes the first round that is whole; in which order is up to the sender."""

    def _found(self) -> TurnOrder | None:
        size = len(_MESSAGES)
        last = self.keys[-size:]
        if len(set(last)) == size:
            return TurnOrder(last, _PERIOD)
        self._forget(max(0, len(self.keys) - 2 * size))
        return None


RULE = Rule(
    id="pack-code-transfer",
    title=Text("The pack code comes whole", "电池包编码完整发送"),
    purpose=Text(
        "The code is spread over four messages: while it is requested each of them comes once in "
        "every round. Their order is not printed, and not judged.",
        "编码分布在四条报文中:请求期间每一轮应各发送一次。标准未规定其顺序,因此不作判定。",
    ),
    clause="5.1.7; 5.2.3; Table 8; A.1 (period 1000 ms)",
    severity=Severity.MUST,
    judges=(_NODE,),
    tolerances=(_PERIODS,),
    watch=PackCodeTransfer,
)
