"""The state HV closed comes after Precharge."""

from __future__ import annotations

import numpy as np

from swapcan.messages import B2V_ST1, BmsState
from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text

_STEP = Tolerance(
    name="hv-state-order.step",
    value=0.25,
    unit="s",
    text=Text(
        "two B2V_ST1 that are further apart may have a whole precharge between them",
        "两帧 B2V_ST1 间隔超过该值时,其间可能完成一次预充,不予判断",
    ),
)

_SUBJECT = Subject("BMU", "B2V_ST1", "B2V_ST1_BMS")

_SKIPPED = Text(
    "HV closed {seconds:.2f} s after {before}, with no Precharge between them",
    "{before} 之后 {seconds:.2f} s 即为 HV closed,其间没有 Precharge",
)


class HvStateOrder(Watcher):
    """Looks at the state before each HV closed."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._step = findings.limit(_STEP)

    def feed(self, chunk: Chunk) -> None:
        """Judge the changes to HV closed."""
        states = chunk.sound(B2V_ST1)
        state, step = states.raw("bms"), np.diff(states.time)
        closes = (state[1:] == BmsState.HV_CLOSED) & (state[:-1] != BmsState.HV_CLOSED)
        closes &= step <= self._step
        self.findings.examine("BMU", int(np.count_nonzero(closes)))
        for row in np.flatnonzero(closes & (state[:-1] != BmsState.PRECHARGE)).tolist():
            time = float(states.time[row + 1])
            labels = B2V_ST1.FIELDS["bms"].labels
            self.findings.add(
                Occurrence(
                    subject=_SUBJECT,
                    start=time,
                    end=time,
                    order=int(states.order[row + 1]),
                    measure=1.0,
                    text=_SKIPPED,
                    values={"seconds": float(step[row]), "before": labels[int(state[row])]},
                )
            )


RULE = Rule(
    id="hv-state-order",
    title=Text("HV closed comes after Precharge", "HV closed 状态出现在 Precharge 之后"),
    purpose=Text(
        "On the command the BMS precharges, and only then reports high voltage: the VCU waits "
        "for the states in this order.",
        "电池管理系统收到上电命令后先进入预充阶段,预充完成后才进入高压上电状态,"
        "VCU 按此顺序等待各状态。",
    ),
    clause="5.2.1.1, Table 1 row 9 (5.1.1)",
    severity=Severity.MUST,
    judges=("BMU",),
    tolerances=(_STEP,),
    watch=HvStateOrder,
)
