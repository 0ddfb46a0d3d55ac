"""All transfers that a node receives, behind one door."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType

from swapcan.transfer.problem import Problem
from swapcan.transfer.reading_assembly import CellAssembler, ProbeAssembler
from swapcan.transfer.readings import (
    CELL_VOLTAGES,
    PROBE_TEMPERATURES,
    CellVoltages,
    ProbeTemperatures,
)
from swapcan.transfer.text import PACK_CODE, VIN, PackCode, Vin
from swapcan.transfer.text_assembly import PackCodeAssembler, VinAssembler
from typedcan.wire.message import Message
from typedcan.wire.protocol import Protocol, Transfer

Assembler = VinAssembler | PackCodeAssembler | CellAssembler | ProbeAssembler

Outcome = Vin | PackCode | CellVoltages | ProbeTemperatures | Problem
"""What a message can bring about."""


class Transfers:
    """The assemblers of one node; one thread at a time.

    Parameters
    ----------
    protocol
        Its transfers named vin, pack_code, cell_voltages and probe_temperatures are put together.
    check_vin
        Whether a VIN must be one after ISO 3779, check digit included.
    """

    def __init__(self, protocol: Protocol, *, check_vin: bool = False) -> None:
        makers: dict[str, Callable[[Transfer], Assembler]] = {
            VIN.name: lambda transfer: VinAssembler(check=check_vin, transfer=transfer),
            PACK_CODE.name: lambda transfer: PackCodeAssembler(transfer=transfer),
            CELL_VOLTAGES.name: lambda transfer: CellAssembler(transfer=transfer),
            PROBE_TEMPERATURES.name: lambda transfer: ProbeAssembler(transfer=transfer),
        }
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

    def take(self, message: Message, at: float) -> tuple[Outcome, ...]:
        """What a message brings about: results, problems, or neither; any message will do.

        ``at`` is the time in seconds.
        """
        outcomes: tuple[Outcome, ...] = ()
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
