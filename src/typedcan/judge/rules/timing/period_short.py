"""Frames of a periodic message do not come in bursts."""

from __future__ import annotations

from collections.abc import Collection
from functools import partial

from typedcan.judge.chunk import Chunk
from typedcan.judge.findings import Findings
from typedcan.judge.measure.presence import nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.rules.timing.by_turns import watch_periods
from typedcan.judge.rules.timing.step_findings import add_steps
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol

_SHARE = Tolerance(
    name="period-short.share",
    value=0.5,
    text=Text(
        "periods that lie between two frames at least: nearer, one of them is not in its period",
        "两帧之间的最小间隔(周期的倍数),小于该值说明其中一帧不在其周期内",
    ),
)

_SHORT = Text(
    "{step:.3g} s after the frame before ({periods:.3g} periods), at least {limit:.3g} s are due",
    "距前一帧仅 {step:.3g} s(周期的 {periods:.3g} 倍),至少应为 {limit:.3g} s",
)


class PeriodShort(Watcher):
    """Looks for short steps."""

    def __init__(
        self, findings: Findings, *, messages: Collection[type[Message]], by_frame: bool
    ) -> None:
        super().__init__(findings)
        self._messages = messages
        self._by_frame = by_frame

    def feed(self, chunk: Chunk) -> None:
        """Judge the steps that end here."""
        share = self.findings.limit(_SHARE)
        for message in self._messages:
            steps = chunk.timing.of(message, by_frame=self._by_frame)
            if steps is not None and message.PERIOD:
                limit = share * message.PERIOD
                short_by = 1 - steps.length / message.PERIOD
                wrong = steps.length < limit
                add_steps(self.findings, steps, wrong, short_by, _SHORT, {"limit": limit})


def rule(protocol: Protocol) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="period-short",
        title=Text("Periodic frames keep their distance", "周期报文保持间隔"),
        purpose=Text(
            "Frames in bursts keep others from the bus, and a receiver may see the last one only.",
            "突发报文会占用总线,接收方可能只处理最后一帧。",
        ),
        severity=Severity.SHOULD,
        judges=nodes_of(protocol),
        tolerances=(_SHARE,),
        watch=partial(watch_periods, protocol=protocol, make=PeriodShort),
    )
