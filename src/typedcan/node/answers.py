"""The answers to requests: how each is put together, and what is told where it does not come."""

from __future__ import annotations

from typing import Generic, Protocol, TypeVar

from typedcan.spoken.words import Same
from typedcan.transfer import Assembler, Problem
from typedcan.wire.message import Message, MessageT

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)


class Collector(Protocol[T_co]):
    """Puts the answer to one request together."""

    def take(self, message: Message, at: float) -> T_co | None:
        """Take a message of the answer; the answer once it is complete."""
        ...

    def missing(self) -> str:
        """What is not there yet, in a few words."""
        ...


class MessageCollector(Generic[MessageT]):
    """Waits for a message."""

    def __init__(self, kind: type[MessageT]) -> None:
        self._kind = kind

    def take(self, message: Message, at: float) -> MessageT | None:  # noqa: ARG002 - a Collector
        """The message, if it is the one that is waited for."""
        return message if isinstance(message, self._kind) else None

    def missing(self) -> str:
        """That it has not come."""
        return f"{self._kind.NAME} has not come"


class TransferCollector(Generic[T]):
    """Waits for a transfer to be complete, with an assembler that has seen nothing before."""

    def __init__(self, assembler: Assembler[T]) -> None:
        self._assembler = assembler
        self._problem: Problem | None = None

    def take(self, message: Message, at: float) -> T | None:
        """Take a message of the transfer; its value once it is complete."""
        for outcome in self._assembler.take(message, at):
            if not isinstance(outcome, Problem):
                return outcome
            self._problem = outcome
        return None

    def missing(self) -> str:
        """What still lacks, and what was wrong last."""
        missing = self._assembler.missing()
        return f"{missing} ({self._problem.text})" if self._problem else missing


def heard(collector: Collector[T], words: Same) -> Collector[T]:
    """A collector that takes messages as they are spoken; transfers are put together as such."""
    return collector if isinstance(collector, TransferCollector) else _Heard(collector, words)


class _Heard(Generic[T]):
    """Hands messages on to a collector, as the program has them."""

    def __init__(self, collector: Collector[T], words: Same) -> None:
        self._collector = collector
        self._words = words
        self.missing = collector.missing

    def take(self, message: Message, at: float) -> T | None:
        """Take a message of the answer; the answer once it is complete."""
        return self._collector.take(self._words.heard(message), at)
