"""A live node of the standard: what any node does, and what the standard lets it ask for."""

from __future__ import annotations

from collections.abc import AsyncGenerator, Callable, Iterable, Mapping
from typing import Any, overload

import can

from swapcan.messages import V2B_VIN, B2V_BattInfo1, B2V_SysCode1
from swapcan.node.answers import BatteryInfo, BatteryInfoCollector, Event
from swapcan.transfer import PackCode, Transfers, Vin
from swapcan.transfer.text import PACK_CODE, VIN
from typedcan.node import node
from typedcan.node.answers import TransferCollector
from typedcan.node.clock import Clock
from typedcan.node.engine import Leave
from typedcan.node.node import EventT
from typedcan.node.request import Pending
from typedcan.wire.codec import Codec
from typedcan.wire.link import Received
from typedcan.wire.message import Message, MessageT
from typedcan.wire.protocol import Protocol


class Node(node.Node):
    """One node on a bus of python-can, live; see `typedcan.node.node.Node` for the parameters.

    VIN, pack code, cell voltages and probe temperatures are put together, and told as events.
    """

    def __init__(
        self,
        protocol: Protocol,
        name: str,
        bus: can.BusABC,
        *,
        codec: Codec | None = None,
        clock: Clock | None = None,
        expect: Iterable[type[Message]] | None = None,
        timeout_periods: float = 5.0,
        late_periods: float = 1.5,
        timeouts: Mapping[type[Message], float] | None = None,
        reopen: Callable[[], can.BusABC] | None = None,
        leave: Leave = "safe",
    ) -> None:
        super().__init__(
            protocol,
            name,
            bus,
            codec=codec,
            clock=clock,
            expect=expect,
            timeout_periods=timeout_periods,
            late_periods=late_periods,
            timeouts=timeouts,
            reopen=reopen,
            leave=leave,
            transfers=Transfers(codec.protocol if codec else protocol),
        )

    @overload
    def events(
        self, kind: type[MessageT], *, limit: int = 10_000
    ) -> AsyncGenerator[Received[MessageT], None]: ...
    @overload
    def events(
        self, kind: type[EventT], *, limit: int = 10_000
    ) -> AsyncGenerator[EventT, None]: ...
    @overload
    def events(self, *, limit: int = 10_000) -> AsyncGenerator[Event, None]: ...
    def events(
        self, kind: type[Any] | None = None, *, limit: int = 10_000
    ) -> AsyncGenerator[Any, None]:
        """Events from now on, as `typedcan.node.node.Node` has them."""
        return super().events(limit=limit) if kind is None else super().events(kind, limit=limit)

    def request_vin(self, timeout: float = 5.0, *, again: float = 1.0) -> Pending[Vin]:
        """Ask for the VIN of the vehicle.

        The request is repeated every ``again`` seconds until it is answered, and withdrawn then,
        after ``timeout`` seconds, or when it is cancelled. Other fields of the message that asks
        stay as they were last. Raises `RequestError` where this node has no such request, or has
        it under way.
        """
        return self.ask(
            "VIN", V2B_VIN, TransferCollector(self._transfers.assembler(VIN.name)), timeout, again
        )

    def request_pack_code(self, timeout: float = 5.0, *, again: float = 1.0) -> Pending[PackCode]:
        """Ask for the code of the pack; see `request_vin`.

        The pack sends it every second, and it counts once it has come twice the same.
        """
        collector = TransferCollector(self._transfers.assembler(PACK_CODE.name))
        return self.ask("pack code", B2V_SysCode1, collector, timeout, again)

    def request_battery_info(
        self, timeout: float = 5.0, *, again: float = 1.0
    ) -> Pending[BatteryInfo]:
        """Ask what the pack is made of; see `request_vin`."""
        collector = BatteryInfoCollector()
        return self.ask("battery info", B2V_BattInfo1, collector, timeout, again)
