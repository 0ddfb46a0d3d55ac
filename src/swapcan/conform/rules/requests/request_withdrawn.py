"""Requests are withdrawn once they are answered."""

from __future__ import annotations

from swapcan._generated.protocol import PROTOCOL
from swapcan.conform.chunk import Chunk
from swapcan.conform.findings import Findings, Occurrence, Subject
from swapcan.conform.rule import Rule, Severity, Watcher
from swapcan.conform.rules.requests.spells import Moment, Spell, Spells
from swapcan.conform.text import Text
from swapcan.conform.tolerance import Tolerance
from typedcan.wire.protocol import Request

_SECONDS = Tolerance(
    name="request-withdrawn.seconds",
    value=10.0,
    unit="s",
    text=Text(
        "From the last of the answers to the withdrawal: ten rounds of a pack code",
        "从收到全部应答到撤销请求的时间:可重复发送十次电池包编码",
    ),
)

_HELD = Text(
    "in force for {held:.1f} s after its answer; {limit:.3g} s are enough",
    "收到应答后请求仍保持 {held:.1f} s,{limit:.3g} s 已足够",
)


class RequestWithdrawn(Watcher):
    """Measures how long each request stays in force after its answer."""

    def __init__(self, findings: Findings) -> None:
        super().__init__(findings)
        self._limit = findings.limit(_SECONDS)
        self._all = [Spells(request) for request in PROTOCOL.requests]

    def take(self, chunk: Chunk) -> None:
        """Judge the requests that end."""
        for spells in self._all:
            for spell in spells.take(chunk):
                answered = _answered(spells.request, spell)
                if spell.end and answered:
                    self._judge(spells.request, answered, spell.end.time)

    def finish(self, end: float) -> None:
        """Judge the requests that are still in force, where that is too long already."""
        for spells in self._all:
            answered = spells.open and _answered(spells.request, spells.open)
            if answered and end - answered.time > self._limit:
                self._judge(spells.request, answered, end)

    def _judge(self, request: Request, answered: Moment, end: float) -> None:
        message, field = request.field
        self.findings.examine(message.SENDER)
        held = end - answered.time
        if held <= self._limit:
            return
        found = Occurrence(
            subject=Subject(message.SENDER, message.NAME, message.FIELDS[field].dbc_name),
            start=answered.time,
            end=end,
            order=answered.order,
            measure=held,
            text=_HELD,
            values={"held": held, "limit": self._limit},
        )
        self.findings.add(found)


def _answered(request: Request, spell: Spell) -> Moment | None:
    """The frame with which the answer was complete."""
    if len(spell.answers) < len(request.answers):
        return None
    return max(spell.answers.values(), key=lambda moment: moment.order)


RULE = Rule(
    id="request-withdrawn",
    title=Text("Answered requests are withdrawn", "请求在得到应答后撤销"),
    purpose=Text(
        "A request that stays in force keeps its answers on the bus. That is allowed: A.1 prints "
        "periods for them, so a request may hold; but what they say does not change.",
        "持续有效的请求会使应答报文一直占用总线。标准允许这样做:表 A.1 规定了应答的周期;"
        "但应答内容不会变化。",
    ),
    clause="5.1.3; 5.2.3; A.1",
    severity=Severity.INFO,
    judges=tuple(dict.fromkeys(request.field.message.SENDER for request in PROTOCOL.requests)),
    tolerances=(_SECONDS,),
    watch=RequestWithdrawn,
)
