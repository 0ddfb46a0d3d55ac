"""A node is not silent for long while others are awake."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Subject
from typedcan.judge.measure.presence import Presence, Silence, nodes_of
from typedcan.judge.rule import Rule, Severity, Watcher
from typedcan.judge.scope import Scope
from typedcan.judge.tolerance import Tolerance
from typedcan.report.language import Text
from typedcan.wire.protocol import Protocol

_SECONDS = Tolerance(
    name="node-awake.seconds",
    value=5.0,
    unit="s",
    text=Text(
        "How long a node may be silent while another one sends: more than starting anew takes",
        "其他节点仍在发送时,节点允许沉默的时间:长于重新启动所需",
    ),
)

_SILENT = Text(
    "sends nothing for {step:.3g} s, though {others} did; at most {limit:.3g} s are allowed",
    "{step:.3g} s 内未发送任何报文,而 {others} 仍在发送;最多允许 {limit:.3g} s",
)


class NodeAwake(Watcher):
    """Looks at the silences of a log when it is over, and all are known."""

    def __init__(self, findings: Findings, may_sleep: frozenset[str] = frozenset()) -> None:
        super().__init__(findings)
        self._may_sleep = may_sleep
        self._limit = findings.limit(_SECONDS)

    def feed(self, chunk: Chunk) -> None:
        """Nothing is known before the end."""

    def finish(self, end: LogEnd) -> None:
        """Judge each silence of each node."""
        silences = {node: list(seen.silences) for node, seen in end.nodes.items()}
        for silence in end.silent:
            silences[silence.node].append(silence)
        for node, own in silences.items():
            if node in self._may_sleep:
                continue
            if not any(
                seen.seconds > self._limit for other, seen in end.nodes.items() if other != node
            ):
                continue  # nobody else is awake for so long
            self.findings.examine(node)
            for silence in own:
                awake = [
                    other
                    for other, seen in end.nodes.items()
                    if other != node and _awake(seen, silences[other], silence) > self._limit
                ]
                if awake and not self.excused(silence, awake):
                    self._found(silence, awake)

    def errata(self, silence: Silence) -> tuple[str, ...]:  # noqa: ARG002
        """What a finding rests on where the standard leaves open whether a node may be silent."""
        return ()

    def excused(self, silence: Silence, awake: Sequence[str]) -> bool:  # noqa: ARG002
        """Whether a node may be silent here; ``awake`` are the others that were not."""
        return False

    def _found(self, silence: Silence, others: list[str]) -> None:
        step, errata = silence.end - silence.start, self.errata(silence)
        self.findings.add(
            Occurrence(
                subject=Subject(silence.node),
                start=silence.start,
                end=silence.end,
                order=silence.order,
                measure=step,
                text=_SILENT,
                values={"step": step, "others": ", ".join(others), "limit": self._limit},
                is_open=bool(errata),
                errata=errata,
            )
        )


def _awake(seen: Presence, own: list[Silence], during: Silence) -> float:
    """Seconds for which a node was awake during the silence of another one."""
    silent = sum(_overlap(each.start, each.end, during) for each in own)
    return _overlap(seen.first, seen.last, during) - silent


def _overlap(start: float, end: float, during: Silence) -> float:
    return max(min(end, during.end) - max(start, during.start), 0.0)


def rule(protocol: Protocol, scope: Scope) -> Rule:
    """The rule of a protocol."""
    return Rule(
        id="node-awake",
        title=Text("Nodes are awake while others are", "其他节点工作时节点不沉默"),
        purpose=Text(
            "Who is awake relies on what the others tell.",
            "工作中的节点依赖其他节点的报文。",
        ),
        severity=Severity.SHOULD,
        judges=tuple(node for node in nodes_of(protocol) if node not in scope.may_sleep),
        tolerances=(_SECONDS,),
        watch=partial(NodeAwake, may_sleep=scope.may_sleep),
    )
