"""Transfers put together from typed messages, and all those of a node behind one door."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from operator import attrgetter
from types import MappingProxyType
from typing import Any, Generic, TypeVar

from typedcan.model.transfers.blocks import Blocks
from typedcan.model.transfers.kind import Problem
from typedcan.model.transfers.parts import Part
from typedcan.model.transfers.reading_rules import Readings
from typedcan.model.transfers.recognising import Recognising, rules_of
from typedcan.model.transfers.registry import KINDS, problems
from typedcan.model.transfers.text import Text
from typedcan.transfer.split import TransferError
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer

Value = Text | Readings | Blocks
"""What a transfer of one of the kinds is when it is complete."""

ResultT_co = TypeVar("ResultT_co", covariant=True)

Make = Callable[[Any], ResultT_co | Problem]
"""Makes a result, or a problem, of a value of the transfer's kind."""

_Read = Callable[[Message], tuple[Any, ...]]


class Assembler(Generic[ResultT_co]):
    """Puts one transfer together; one thread at a time.

    Parameters
    ----------
    transfer
        What the protocol says of it; raises `TransferError` where it does not fit its kind.
    make
        What becomes of a value; nothing else if none is given.
    timeout
        Seconds in which all frames must have come, or that a reading in a result may be old; None:
        as the protocol has it.
    rounds
        How often in a row the same must come before it counts; None: as the protocol has it.
    """

    def __init__(
        self,
        transfer: Transfer,
        make: Make[ResultT_co] | None = None,
        *,
        timeout: float | None = None,
        rounds: int | None = None,
    ) -> None:
        wrong = unfit(transfer)
        if wrong:
            raise TransferError(transfer.name, wrong)
        self.transfer = transfer
        self._make = make
        self._rules = rules_of(transfer.parts, timeout, rounds)
        self._readers: dict[type[Message], tuple[str, _Read]] = {}
        for name, parts in self._rules.wanted.items():
            message = transfer.classes[name]
            self._readers[message] = (name, _reader(parts))

    @property
    def messages(self) -> tuple[type[Message], ...]:
        """Those that say something about the transfer."""
        return tuple(self._readers)

    @property
    def deadline(self) -> float:
        """When `expire` has something to do if no frame arrives; `math.inf` for never."""
        return self._rules.deadline

    @property
    def duplicates(self) -> int:
        """Frames that came again before the set was complete."""
        return self._rules.duplicates

    @property
    def readings(self) -> tuple[str, ...]:
        """The readings of the spec in which values came, where it has several and frames tell."""
        return self._rules.readings if isinstance(self._rules, Recognising) else ()

    def take(self, message: Message, at: float) -> tuple[ResultT_co | Problem, ...]:
        """What a message brings about: a result, problems, or neither.

        Messages of other transfers bring nothing about. ``at`` is the time in seconds.
        """
        known = self._readers.get(type(message))
        if known is None:
            return ()
        name, read = known
        outcomes = self._rules.feed(name, read(message), at)
        if not outcomes or self._make is None:
            return outcomes
        make = self._make
        return tuple(each if isinstance(each, Problem) else make(each) for each in outcomes)

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time."""
        return self._rules.expire(now)

    def missing(self) -> str:
        """What still lacks for a result."""
        return self._rules.missing()

    def reset(self) -> None:
        """Forget all that was received; how much there is stays."""
        self._rules.reset()


class Transfers:
    """The assemblers of one node; one thread at a time.

    Parameters
    ----------
    protocol
        Whose transfers. One that does not fit its kind is passed over; `missing` says why.
    results
        By the names of some transfers, the class of their results, and what makes one of a value;
        results of the others are the values of their kinds.
    """

    def __init__(
        self,
        protocol: Protocol,
        results: Mapping[str, tuple[type[Any], Make[Any]]] | None = None,
    ) -> None:
        self._results = results or {}
        self._protocol = protocol
        self._unfit = {each.name: unfit(each) for each in protocol.transfers}
        self.assemblers: Mapping[str, Assembler[Any]] = MappingProxyType(
            {name: self.assembler(name) for name, wrong in self._unfit.items() if not wrong}
        )
        """The assemblers by the name of their transfer."""
        self._routes: dict[type[Message], tuple[Assembler[Any], ...]] = {}
        for assembler in self.assemblers.values():
            for message in assembler.messages:
                self._routes[message] = (*self._routes.get(message, ()), assembler)

    @property
    def messages(self) -> frozenset[type[Message]]:
        """Those that say something about a transfer."""
        return frozenset(self._routes)

    @property
    def next_deadline(self) -> float:
        """When `expire` has something to do if nothing arrives; `math.inf` for never."""
        deadlines = (assembler.deadline for assembler in self.assemblers.values())
        return min(deadlines, default=math.inf)

    @property
    def readings(self) -> Mapping[str, tuple[str, ...]]:
        """By transfer, the readings of the spec in which values came, as far as frames told."""
        found = {name: each.readings for name, each in self.assemblers.items()}
        return {name: readings for name, readings in found.items() if readings}

    def assembler(self, name: str) -> Assembler[Any]:
        """Another assembler of the transfer of that name, which has seen nothing yet.

        Raises `LookupError` for a name that there is not, and `TransferError`.
        """
        _, make = self._results.get(name, (None, None))
        return Assembler(self._protocol.transfer(name), make)

    def result_of(self, name: str) -> type[Any]:
        """The class of the results of the transfer of that name; raises `LookupError`."""
        if name in self._results:
            return self._results[name][0]
        kind: type[Any] = KINDS[self.assemblers[name].transfer.parts.transfer.kind].value
        return kind

    def take(self, message: Message, at: float) -> tuple[Any, ...]:
        """What a message brings about: results, problems, or neither; any message will do.

        ``at`` is the time in seconds.
        """
        assemblers = self._routes.get(type(message), ())
        if len(assemblers) == 1:  # as nearly always
            return assemblers[0].take(message, at)
        outcomes: tuple[Any, ...] = ()
        for assembler in assemblers:
            outcomes += assembler.take(message, at)
        return outcomes

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time, in all transfers."""
        return tuple(
            problem for assembler in self.assemblers.values() for problem in assembler.expire(now)
        )

    def missing(self, name: str) -> str:
        """What the transfer of that name still lacks for a result; raises `LookupError`."""
        if self._unfit.get(name):
            return self._unfit[name]
        return self.assemblers[name].missing()


def unfit(transfer: Transfer) -> str:
    """Why a transfer cannot be put together; empty where it can."""
    found = problems(transfer.parts.transfer, transfer.parts.protocol)
    return "; ".join(f"{problem.key}: {problem.text}" for problem in found)


def _reader(parts: tuple[Part, ...]) -> _Read:
    """What takes the values of some fields."""
    names = [part.signal.python_name for part in parts]
    get: Callable[[Message], Any] = attrgetter(*names)
    return get if len(names) > 1 else lambda message: (get(message),)
