"""No node falls silent while high voltage is on."""

from __future__ import annotations

import numpy as np

from swapcan._generated.protocol import PROTOCOL
from swapcan.messages import B2V_ST1
from swapcan.rules.voltage.known_silences import HV_ON, KnownSilence, Silences
from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.report.language import Text

_SILENT = Text(
    "sends nothing for {step:.3g} s, though high voltage was on when it fell silent",
    "{step:.3g} s 内未发送任何报文,而开始沉默时高压处于接通状态",
)


class NodeSilence(Watcher):
    """Looks for silences that begin while high voltage is on."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._silences = Silences()
        self._was_on = False

    def feed(self, chunk: Chunk) -> None:
        """Judge the silences that end here."""
        for each in self._silences.feed(chunk):
            self._judge(each)
        status = chunk.sound(B2V_ST1)
        if status.fresh and not self._was_on:
            self._was_on = bool(np.isin(status.new_raw("bms"), HV_ON).any())

    def finish(self, end: LogEnd) -> None:
        """Judge those that last to the end."""
        for each in self._silences.finish(end):
            self._judge(each)
        if self._was_on:
            for node in end.nodes:
                self.findings.examine(node)

    def _judge(self, found: KnownSilence) -> None:
        if not found.told:
            return
        silence = found.silence
        step = silence.end - silence.start
        self.findings.add(
            Occurrence(
                subject=Subject(silence.node),
                start=silence.start,
                end=silence.end,
                order=silence.order,
                measure=step,
                text=_SILENT,
                values={"step": step},
            )
        )


RULE = Rule(
    id="node-silence",
    title=Text("Nodes are not silent under high voltage", "高压接通时节点不沉默"),
    purpose=Text(
        "Nodes sleep after the command to switch off; before, others rely on what they tell.",
        "节点在下电指令之后才休眠;在此之前其他节点依赖其报文。",
    ),
    clause="A.1, 5.2.1.4",
    severity=Severity.MUST,
    judges=PROTOCOL.nodes,
    watch=NodeSilence,
)
