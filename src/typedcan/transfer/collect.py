"""All transfers that a node receives, behind one door."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any
from typing import Protocol as Shape

from typedcan.transfer.problem import Problem
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer


class Assembler(Shape):
    """Puts one transfer together."""

    @property
    def deadline(self) -> float:
        """When `expire` has something to do if no frame arrives; `math.inf` for never."""
        ...

    def take(self, message: Message, at: float) -> tuple[Any, ...]:
        """What a message brings about: a result, problems, or neither."""
        ...

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time."""
        ...

    def missing(self) -> str:
        """What still lacks for a result."""
        ...


class Transfers:
    """The assemblers of one node; one thread at a time.

    Parameters
    ----------
    protocol
        Whose transfers.
    makers
        Make the assemblers of those that are put together, by the names of the transfers.
    """

    def __init__(
        self, protocol: Protocol, makers: Mapping[str, Callable[[Transfer], Assembler]]
    ) -> None:
        known = [transfer for transfer in protocol.transfers if transfer.name in makers]
        self.assemblers: Mapping[str, Assembler] = MappingProxyType(
            {transfer.name: makers[transfer.name](transfer) for transfer in known}
        )
        """The assemblers by the name of their transfer."""
        self._routes: dict[type[Message], tuple[Assembler, ...]] = {}
        for transfer in known:
            for message in _messages(transfer):
                others = self._routes.get(message, ())
                self._routes[message] = (*others, self.assemblers[transfer.name])

    @property
    def next_deadline(self) -> float:
        """When `expire` has something to do if nothing arrives; `math.inf` for never."""
        deadlines = (assembler.deadline for assembler in self.assemblers.values())
        return min(deadlines, default=math.inf)

    def take(self, message: Message, at: float) -> tuple[Any, ...]:
        """What a message brings about: results, problems, or neither; any message will do.

        ``at`` is the time in seconds.
        """
        outcomes: tuple[Any, ...] = ()
        for assembler in self._routes.get(type(message), ()):
            outcomes += assembler.take(message, at)
        return outcomes

    def expire(self, now: float) -> tuple[Problem, ...]:
        """What is overdue at that time, in all transfers."""
        return tuple(
            problem for assembler in self.assemblers.values() for problem in assembler.expire(now)
        )

    def missing(self, name: str) -> str:
        """What the transfer of that name still lacks for a result; raises `LookupError`."""
        return self.assemblers[name].missing()


def _messages(transfer: Transfer) -> set[type[Message]]:
    """The messages that say something about a transfer."""
    totals = (transfer.count_field, transfer.groups_field)
    return {*transfer.messages, *(ref.message for ref in totals if ref)}
