"""What rules share that judge all steps of a message together, at the end of the log."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Collection

from typedcan.judge.chunk import Chunk, LogEnd
from typedcan.judge.findings import Findings, Occurrence, Said, Subject
from typedcan.judge.measure.spread import Spread
from typedcan.judge.measure.steps import Steps
from typedcan.judge.rule import Watcher
from typedcan.wire.message import Message


class WholeLog(Watcher):
    """Adds up the steps of each message."""

    def __init__(
        self, findings: Findings, *, messages: Collection[type[Message]], by_frame: bool
    ) -> None:
        super().__init__(findings)
        self._by_frame = by_frame
        self._spread = dict.fromkeys(messages, Spread())

    @property
    @abstractmethod
    def least(self) -> float:
        """Steps that it takes to judge a message."""

    @abstractmethod
    def judge(self, period: float, spread: Spread) -> tuple[float, Said | None]:
        """How far off the steps of a message are, and what is wrong with them, if anything."""

    def spread(self, period: float, steps: Steps) -> Spread:  # noqa: ARG002
        """Of the steps that count."""
        return steps.spread

    def feed(self, chunk: Chunk) -> None:
        """Add the steps that end here."""
        for message in self._spread:
            steps = chunk.timing.of(message, by_frame=self._by_frame)
            if steps is not None and message.PERIOD:
                self._spread[message] += self.spread(message.PERIOD, steps)

    def finish(self, end: LogEnd) -> None:
        """Judge each message that came often enough."""
        for message, spread in self._spread.items():
            if not message.PERIOD or spread.count < max(self.least, 1):
                continue
            seen = end.messages[message]
            self.findings.examine(message.SENDER)
            measure, said = self.judge(message.PERIOD, spread)
            if said:
                self.findings.add(
                    Occurrence(
                        subject=Subject(message.SENDER, message.NAME),
                        start=seen.first,
                        end=seen.last,
                        order=seen.first_order,
                        frames=seen.frames,
                        measure=measure,
                        text=said[0],
                        values=said[1],
                    )
                )
