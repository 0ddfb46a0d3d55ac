"""Judging by several readings at once, where a log shows at its end which of them holds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings
from typedcan.judge.rule import Watcher
from typedcan.model import protocol as model
from typedcan.model.variants import changes_of, choose

Making = Callable[[Findings], Watcher]


class OneOf(Watcher):
    """Watches by each reading apart; the findings are those of the one that holds.

    Parameters
    ----------
    make
        What watches by each reading, the usual one first.
    holds
        Which of them it was, by the end of the log; none: that of the fewest findings.
    """

    def __init__(
        self,
        findings: Findings,
        make: Sequence[Making],
        holds: Callable[[LogEnd], int] | None = None,
    ) -> None:
        super().__init__(findings)
        self._readings = [each(findings.apart()) for each in make]
        self._holds = holds

    def feed(self, chunk: Chunk) -> None:
        """Judge by each reading."""
        for watcher in self._readings:
            watcher.feed(chunk)

    def finish(self, end: LogEnd) -> None:
        """Take what was found by the reading that holds."""
        for watcher in self._readings:
            watcher.finish(end)
        found = [watcher.findings for watcher in self._readings]
        best = self._holds(end) if self._holds else _fewest([each.count for each in found])
        self.findings.take(found[best])


class Together(Watcher):
    """Several watchers as one."""

    def __init__(self, findings: Findings, watchers: Sequence[Watcher]) -> None:
        super().__init__(findings)
        self._watchers = watchers

    def feed(self, chunk: Chunk) -> None:
        """Let all of them judge."""
        for watcher in self._watchers:
            watcher.feed(chunk)

    def finish(self, end: LogEnd) -> None:
        """Let all of them judge what is left."""
        for watcher in self._watchers:
            watcher.finish(end)


def readings_of(protocol: model.Protocol, fact: str) -> Iterator[model.Message]:
    """The messages as other readings have them that the spec lists, where they differ in a fact.

    Of a protocol in a chosen edition or reading there are none: who chooses means it.
    """
    if protocol.chosen:
        return
    for variant in protocol.variants:
        paths = [path.split("/") for path, _ in changes_of(variant)]
        changed = {path[1] for path in paths if path[0] == "messages" and fact in path[2:3]}
        if changed and not variant.is_edition:
            other = choose(protocol, [variant.name])
            yield from (each for each in other.messages if each.name in changed)


def _fewest(counts: Sequence[int]) -> int:
    return counts.index(min(counts))
